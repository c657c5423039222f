// Shader text taken apart: conditions decided, declarations with what they name and use.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "glsl/expand.h"

namespace arealab {

// A line of the text with the file that it came from.
struct TextLine {
  std::string text;
  std::string file;
};

struct DecidedText {
  std::vector<TextLine> lines;
  std::map<std::string, std::string> host;  // macros that the host defines: gone from the text
};

// A declaration with the comment above it, or (nothing declared) the comment that opens a file.
struct Declaration {
  std::string text;
  std::string file;
  std::set<std::string> names, uses;
};

// Takes every condition: all that a shader asks is known.
DecidedText Decide(const ExpandedSource& source);

std::vector<Declaration> Declarations(const std::vector<TextLine>& lines);

std::string_view Trimmed(std::string_view text);
std::string WithoutComments(std::string_view text);
std::set<std::string> Words(std::string_view code);

// Replaces words of code, comments left alone.
std::string ReplaceWords(const std::string& text, const std::map<std::string, std::string>& by);

}  // namespace arealab
