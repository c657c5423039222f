// Characters and words of shader text, ASCII.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace arealab {

inline bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }
inline bool IsWordStart(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
inline bool IsWord(char c) { return IsWordStart(c) || IsDigit(c); }

inline bool IsAnyOf(std::string_view word, const auto& list) { return std::ranges::find(list, word) != list.end(); }

inline std::string Upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace arealab
