#include "glsl/fp64_rewrite.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "glsl/words.h"

namespace arealab {

namespace {

// GLSL 4.50, § 8.1 and 8.2: the built-in functions of genType alone, with no genDType form.
constexpr std::array<std::string_view, 16> kFloatOnly{"acos", "asin", "atan", "cos",  "cosh", "degrees",
                                                      "exp",  "exp2", "log",  "log2", "pow",  "radians",
                                                      "sin",  "sinh", "tan",  "tanh"};

// vec2, mat3, mat4x3: a type whose double form has a d before it.
bool IsFloatVectorType(std::string_view word) {
  if (word.size() < 4 || (!word.starts_with("vec") && !word.starts_with("mat"))) return false;
  const auto is_size = [](char c) { return c >= '2' && c <= '4'; };
  const std::string_view size = word.substr(3);
  if (size.size() == 1) return is_size(size[0]);
  return word.starts_with("mat") && size.size() == 3 && is_size(size[0]) && size[1] == 'x' &&
         is_size(size[2]);
}

class Rewriter {
 public:
  explicit Rewriter(std::string_view text) : text_(text) {}

  std::string Run() {
    while (at_ < text_.size()) Step();
    return std::move(out_);
  }

 private:
  char Peek(std::size_t ahead) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

  // Copies up to `end`, unchanged.
  void Copy(std::size_t end) {
    end = std::min(end, text_.size());
    out_ += text_.substr(at_, end - at_);
    at_ = end;
  }

  void Step() {
    const char c = text_[at_];
    if (c == '/' && Peek(1) == '/') {
      Copy(text_.find('\n', at_));
    } else if (c == '/' && Peek(1) == '*') {
      const auto end = text_.find("*/", at_ + 2);
      Copy(end == std::string_view::npos ? text_.size() : end + 2);
    } else if (c == '\n') {
      line_is_blank_ = true;
      Copy(at_ + 1);
    } else if (std::isspace(static_cast<unsigned char>(c))) {
      Copy(at_ + 1);
    } else if (c == '#' && line_is_blank_) {
      Directive();
    } else {
      line_is_blank_ = false;
      Token();
    }
  }

  void Token() {
    const char c = text_[at_];
    if (IsWordStart(c)) {
      Word();
    } else if (IsDigit(c) || (c == '.' && IsDigit(Peek(1)))) {
      Number();
    } else {
      previous_ = c;
      Copy(at_ + 1);
    }
  }

  // After `#define NAME` the body goes on as code; any other directive is copied whole, continued lines too.
  void Directive() {
    const auto word = text_.find_first_not_of(" \t", at_ + 1);
    constexpr std::string_view kDefine = "define";
    if (word != std::string_view::npos && text_.substr(word).starts_with(kDefine)) {
      const auto name = text_.find_first_not_of(" \t", word + kDefine.size());
      Copy(name);
      while (IsWord(Peek(0))) Copy(at_ + 1);
      line_is_blank_ = false;
      return;
    }
    std::size_t end = at_;
    do {
      end = text_.find('\n', end + 1);
    } while (end != std::string_view::npos && text_[end - 1] == '\\');
    Copy(end);
  }

  void Word() {
    std::size_t end = at_;
    while (end < text_.size() && IsWord(text_[end])) ++end;
    const std::string_view word = text_.substr(at_, end - at_);
    const bool is_member = previous_ == '.';
    if (word == "float" && !is_member) {
      out_ += "double";
    } else if (IsFloatVectorType(word) && !is_member) {
      out_ += 'd';
      out_ += word;
    } else if (IsAnyOf(word, kFloatOnly) && !is_member && IsCall(end)) {
      out_ += "fp64_";
      out_ += word;
    } else {
      out_ += word;
    }
    at_ = end;
    previous_ = word.back();
  }

  bool IsCall(std::size_t end) const {
    const auto next = text_.find_first_not_of(" \t", end);
    return next != std::string_view::npos && text_[next] == '(';
  }

  // Integers, also hexadecimal, are copied; a fraction or an exponent makes a float literal.
  void Number() {
    std::size_t end = at_;
    const bool is_hexadecimal = text_[at_] == '0' && (Peek(1) == 'x' || Peek(1) == 'X');
    while (end < text_.size() &&
           (IsWord(text_[end]) || text_[end] == '.' || IsExponentSign(end, is_hexadecimal)))
      ++end;
    std::string_view number = text_.substr(at_, end - at_);
    const bool is_float = !is_hexadecimal && number.find_first_of(".eEfF") != std::string_view::npos;
    if (is_float) {
      const auto suffix = number.find_first_of("fFlL");
      out_ += number.substr(0, suffix);
      out_ += "lf";
    } else {
      out_ += number;
    }
    at_ = end;
    previous_ = '0';
  }

  bool IsExponentSign(std::size_t at, bool is_hexadecimal) const {
    return !is_hexadecimal && at > at_ && (text_[at] == '+' || text_[at] == '-') &&
           (text_[at - 1] == 'e' || text_[at - 1] == 'E');
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string out_;
  bool line_is_blank_ = true;  // up to here, but for comments
  char previous_ = '\0';       // the last character of code
};

}  // namespace

std::string RewriteAsDouble(std::string_view text) {
  return Rewriter(text).Run();
}

}  // namespace arealab
