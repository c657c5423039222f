#include "glsl/fp16_rewrite.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "glsl/words.h"

namespace arealab {

namespace {

// One operation each, or taken for one: rounded once, as no hardware is better.
constexpr std::array<std::string_view, 20> kRounded{
    "sqrt", "inversesqrt", "exp2", "log2", "sin",  "cos",     "tan",        "asin",       "acos",            "atan",
    "sinh", "cosh",        "tanh", "fract", "radians", "degrees", "float", "texelFetch", "textureLod", "uintBitsToFloat"};
// Several operations each, every one rounded.
constexpr std::array<std::string_view, 13> kSteps{"dot", "cross", "length", "distance", "normalize", "mix", "smoothstep",
                                                  "reflect", "refract", "exp", "log", "pow", "mod"};
// Copied: what follows them is an expression of its own.
constexpr std::array<std::string_view, 4> kKeywords{"return", "else", "do", "case"};
constexpr std::array<std::string_view, 11> kIntegers{"int", "uint", "bool", "ivec2", "ivec3", "ivec4", "uvec2", "uvec3", "uvec4", "bvec2", "bvec3"};

// By precedence, the loosest first; those that round are in the last two rows.
constexpr std::array<std::array<std::string_view, 4>, 11> kBinary{{{"||"},
                                                                   {"^^"},
                                                                   {"&&"},
                                                                   {"|"},
                                                                   {"^"},
                                                                   {"&"},
                                                                   {"==", "!="},
                                                                   {"<", ">", "<=", ">="},
                                                                   {"<<", ">>"},
                                                                   {"+", "-"},
                                                                   {"*", "/", "%"}}};

struct HalfToken {
  std::string lead;  // blanks, comments and directives before it
  std::string text;  // empty: the end
};

class HalfLexer {
 public:
  explicit HalfLexer(std::string_view text) : text_(text) {}

  std::vector<HalfToken> Run() {
    std::vector<HalfToken> tokens;
    do {
      std::string lead = Lead();
      tokens.push_back({std::move(lead), Take(End())});
    } while (!tokens.back().text.empty());
    return tokens;
  }

 private:
  char Peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

  std::string Take(std::size_t end) {
    end = std::min(end, text_.size());
    std::string taken(text_.substr(at_, end - at_));
    at_ = end;
    return taken;
  }

  std::string Lead() {
    std::string lead;
    while (at_ < text_.size()) {
      const char c = Peek();
      if (c == '/' && Peek(1) == '/') {
        lead += Take(text_.find('\n', at_));
      } else if (c == '/' && Peek(1) == '*') {
        const auto end = text_.find("*/", at_ + 2);
        lead += Take(end == std::string_view::npos ? end : end + 2);
      } else if (c == '#') {
        lead += Directive();
      } else if (std::isspace(static_cast<unsigned char>(c)) || c == '\\') {
        lead += Take(at_ + 1);
      } else {
        break;
      }
    }
    return lead;
  }

  // What a macro stands for is an expression too.
  std::string Directive() {
    std::size_t end = at_;
    do {
      end = text_.find('\n', end + 1);
    } while (end != std::string_view::npos && text_[end - 1] == '\\');
    const std::string line = Take(end);
    constexpr std::string_view kDefine = "define ";
    const auto word = line.find_first_not_of(" \t", 1);
    if (word == std::string::npos || !std::string_view(line).substr(word).starts_with(kDefine)) return line;
    std::size_t body = std::min(line.find_first_not_of(" \t", word + kDefine.size()), line.size());
    while (body < line.size() && IsWord(line[body])) ++body;
    if (body < line.size() && line[body] == '(') body = std::min(line.find(')', body), line.size() - 1) + 1;
    return line.substr(0, body) + RewriteAsHalf(std::string_view(line).substr(body));
  }

  // Of the token that begins here.
  std::size_t End() const {
    std::size_t end = at_;
    if (end >= text_.size()) return end;
    const char c = text_[end];
    if (IsDigit(c) || (c == '.' && IsDigit(Peek(1)))) {
      const bool hexadecimal = c == '0' && (Peek(1) == 'x' || Peek(1) == 'X');
      while (end < text_.size() && (IsWord(text_[end]) || text_[end] == '.' ||
                                    (!hexadecimal && end > at_ && (text_[end] == '+' || text_[end] == '-') &&
                                     (text_[end - 1] == 'e' || text_[end - 1] == 'E'))))
        ++end;
      return end;
    }
    while (end < text_.size() && IsWord(text_[end])) ++end;
    if (end > at_) return end;
    for (const std::string_view symbol : {"<<=", ">>=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<", ">>", "<=",
                                          ">=", "==", "!=", "&&", "||", "^^", "++", "--"}) {
      if (text_.substr(at_).starts_with(symbol)) return at_ + symbol.size();
    }
    return at_ + 1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

class HalfRewriter {
 public:
  explicit HalfRewriter(std::string_view text) : tokens_(HalfLexer(text).Run()) {}

  std::string Run() {
    std::string out;
    while (!Now().text.empty()) out += Item().Text();
    return out + Now().lead;
  }

 private:
  struct Part {
    std::string lead, body;
    std::string Text() const { return lead + body; }
  };

  const HalfToken& Now() const { return tokens_[at_]; }
  bool Is(std::string_view symbol) const { return Now().text == symbol; }
  Part Copy() {
    const HalfToken& token = tokens_[at_];
    if (!token.text.empty()) ++at_;
    return {token.lead, token.text};
  }
  Part Rounded(std::string lead, const std::string& value) {
    ++rounded_;
    return {std::move(lead), "fp16(" + value + ")"};
  }

  // An expression, or a token that is part of none.
  Part Item() {
    if (Is("const")) return Constant();
    const char c = Now().text[0];
    const bool operand = IsWord(c) || c == '.' || c == '(' || IsUnary();
    return operand && !IsAnyOf(Now().text, kKeywords) ? Assignment() : Copy();
  }

  bool IsUnary() const { return IsAnyOf(Now().text, std::array<std::string_view, 6>{"+", "-", "!", "~", "++", "--"}); }

  // A value that a function of ours computes is none that the compiler accepts as constant.
  Part Constant() {
    Part word = Copy();
    const bool integer = IsAnyOf(Now().text, kIntegers);
    const int before = rounded_;
    std::string rest;
    for (int depth = 0; !Now().text.empty() && !Is(";") && !Is("{");) {
      if (depth == 0 && (Is(")") || (groups_ > 0 && Is(",")))) break;  // a parameter's end
      if (integer) depth += Is("(") - Is(")");
      rest += (integer ? Copy() : Item()).Text();
    }
    if (rounded_ > before) word.body.clear();
    return {word.lead, word.body + rest};
  }

  Part Assignment() {
    Part left = Ternary();
    const std::string op = Now().text;
    if (op == "=" || op == "%=" || op == "<<=" || op == ">>=" || op == "&=" || op == "|=" || op == "^=") {
      left.body += Copy().Text();
      left.body += Assignment().Text();
    } else if (op == "+=" || op == "-=" || op == "*=" || op == "/=") {
      const std::string lead = Copy().lead;
      const Part right = Assignment();
      left.body += lead + "= " + Rounded("", left.body + " " + op[0] + right.lead + "(" + right.body + ")").body;
    }
    return left;
  }

  Part Ternary() {
    Part left = Binary(0);
    if (!Is("?")) return left;
    left.body += Copy().Text();
    left.body += Assignment().Text();
    if (Is(":")) left.body += Copy().Text();
    left.body += Assignment().Text();
    return left;
  }

  Part Binary(std::size_t level) {
    if (level == kBinary.size()) return Unary();
    Part left = Binary(level + 1);
    while (!Now().text.empty() && IsAnyOf(Now().text, kBinary[level])) {
      const std::string op = Now().text;
      std::string value = left.body + Copy().Text();
      value += Binary(level + 1).Text();
      const bool rounds = op == "+" || op == "-" || op == "*" || op == "/";
      left = rounds ? Rounded(left.lead, value) : Part{left.lead, value};
    }
    return left;
  }

  Part Unary() {
    if (!IsUnary()) return Postfix();
    Part part = Copy();
    part.body += Unary().Text();
    return part;
  }

  Part Postfix() {
    Part part = Primary();
    while (true) {
      if (Is("(")) {
        part = Call(part);
      } else if (Is("[")) {
        part.body += Brackets();
      } else if (Is(".")) {
        part.body += Copy().Text();
        part.body += Copy().Text();
      } else if (Is("++") || Is("--")) {
        part.body += Copy().Text();
      } else {
        return part;
      }
    }
  }

  Part Primary() {
    if (Is("(")) {
      const std::string lead = Now().lead;
      tokens_[at_].lead.clear();
      return {lead, Group()};
    }
    Part part = Copy();
    if (!part.body.empty() && (IsDigit(part.body[0]) || part.body[0] == '.')) part.body = Literal(part.body);
    return part;
  }

  Part Call(const Part& callee) {
    const bool steps = IsAnyOf(callee.body, kSteps);
    const std::string value = (steps ? "fp16_" : "") + callee.body + Group();
    if (IsAnyOf(callee.body, kRounded)) return Rounded(callee.lead, value);
    rounded_ += steps;
    return {callee.lead, value};
  }

  // From ( to ): expressions, also declarations and the parts of a loop's head.
  std::string Group() {
    std::string text = Copy().Text();
    ++groups_;
    while (!Now().text.empty() && !Is(")")) text += Item().Text();
    --groups_;
    return text + Copy().Text();
  }

  std::string Brackets() {
    std::string text = Copy().Text();
    while (!Now().text.empty() && !Is("]")) text += Is("[") ? Brackets() : Copy().Text();
    return text + Copy().Text();
  }

  static std::string Literal(const std::string& number) {
    const bool hexadecimal = number.size() > 1 && (number[1] == 'x' || number[1] == 'X');
    if (hexadecimal || number.find_first_of(".eEfF") == std::string::npos) return number;
    const float half = RoundedToHalf(std::strtod(number.c_str(), nullptr));
    if (std::isinf(half)) return "uintBitsToFloat(0x7f800000u)";
    std::string text = fmt::format("{:.9g}", half);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
  }

  std::vector<HalfToken> tokens_;
  std::size_t at_ = 0;
  int rounded_ = 0;  // results so far
  int groups_ = 0;   // parentheses that are open
};

}  // namespace

float RoundedToHalf(double value) {
  constexpr double kLeast = 0x1p-14, kOverflow = 65520.0;
  if (!std::isfinite(value)) return static_cast<float>(value);
  if (std::abs(value) >= kOverflow) return std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(value));
  if (value == 0.0) return static_cast<float>(value);
  const double ulp = std::ldexp(1.0, std::ilogb(value) - 10);
  const double rounded = std::nearbyint(value / ulp) * ulp;
  return static_cast<float>(std::abs(rounded) < kLeast ? std::copysign(0.0, value) : rounded);
}

std::string RewriteAsHalf(std::string_view text) {
  return HalfRewriter(text).Run();
}

}  // namespace arealab
