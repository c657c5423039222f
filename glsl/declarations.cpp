#include "glsl/declarations.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "glsl/words.h"
#include "scenes/error.h"

namespace arealab {
namespace {

// Calls `code(begin, end)` for each stretch of the text that is no comment.
template <typename Code>
void ForCode(std::string_view text, const Code& code) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t line = text.find("//", begin), block = text.find("/*", begin);
    const std::size_t end = std::min({line, block, text.size()});
    code(begin, end);
    if (end == text.size()) return;
    const std::size_t stop = end == line ? text.find('\n', end) : text.find("*/", end) + 2;
    begin = std::min(stop, text.size());
  }
}

// The value of an #if over integers and the macros known, by precedence climbing.
class Condition {
 public:
  Condition(std::string_view text, const std::map<std::string, std::string>& macros, const std::string& where)
      : rest_(text), macros_(macros), where_(where) {}

  bool Value() {
    const long value = Binary(0);
    if (!Trimmed(rest_).empty()) Fail();
    return value != 0;
  }

 private:
  [[noreturn]] void Fail() const {
    throw InputError(fmt::format("{}: a condition that is not understood near \"{}\"; expected integers, macros and operators", where_,
                                 Trimmed(rest_)));
  }

  void SkipBlanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

  bool Take(std::string_view token) {
    SkipBlanks();
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  long Primary() {
    if (Take("(")) {
      const long value = Binary(0);
      if (!Take(")")) Fail();
      return value;
    }
    SkipBlanks();
    if (Take("!")) return Primary() == 0;
    std::size_t end = 0;
    while (end < rest_.size() && IsWord(rest_[end])) ++end;
    const std::string word(rest_.substr(0, end));
    if (word.empty()) Fail();
    rest_.remove_prefix(end);
    if (std::isdigit(static_cast<unsigned char>(word[0]))) return std::stol(word, nullptr, 0);
    const auto macro = macros_.find(word);
    if (macro == macros_.end()) Fail();
    return Condition(macro->second, macros_, where_).Binary(0);
  }

  long Binary(int least) {
    static constexpr std::pair<std::string_view, int> kOperators[] = {{"||", 1}, {"&&", 2}, {"==", 3}, {"!=", 3}, {"<=", 4},
                                                                      {">=", 4}, {"<", 4},  {">", 4},  {"+", 5},  {"-", 5}};
    long left = Primary();
    for (;;) {
      SkipBlanks();
      const auto found = std::ranges::find_if(kOperators, [&](const auto& op) { return rest_.starts_with(op.first); });
      if (found == std::end(kOperators) || found->second <= least) return left;
      rest_.remove_prefix(found->first.size());
      const long right = Binary(found->second);
      const std::string_view op = found->first;
      left = op == "||" ? (left || right) : op == "&&" ? (left && right) : op == "==" ? left == right : op == "!=" ? left != right
             : op == "<=" ? left <= right : op == ">=" ? left >= right : op == "<" ? left < right : op == ">" ? left > right
             : op == "+" ? left + right : left - right;
    }
  }

  std::string_view rest_;
  const std::map<std::string, std::string>& macros_;
  const std::string& where_;
};

std::pair<std::string, std::string> Definition(std::string_view directive) {  // "define NAME VALUE"
  directive.remove_prefix(std::string_view("define").size());
  directive = Trimmed(directive);
  std::size_t end = 0;
  while (end < directive.size() && IsWord(directive[end])) ++end;
  std::string_view value = directive.substr(end);
  return {std::string(directive.substr(0, end)), std::string(Trimmed(value.substr(0, value.find("//"))))};
}

// What a declaration without comments declares: one name, or those of a uniform block's members.
std::set<std::string> NamesOf(std::string code) {
  std::string_view text = Trimmed(code);
  if (text.starts_with("#")) return {Definition(Trimmed(text.substr(1))).first};
  static const std::regex layout("layout\\s*\\([^)]*\\)");
  code = std::regex_replace(std::string(text), layout, " ");
  text = Trimmed(code);
  const auto last_word = [](std::string_view head) {
    head = Trimmed(head);
    std::size_t begin = head.size();
    while (begin > 0 && IsWord(head[begin - 1])) --begin;
    return std::string(head.substr(begin));
  };
  if (text.starts_with("struct")) return {last_word(text.substr(0, text.find('{')))};
  const std::size_t brace = text.find('{'), stop = text.find_first_of("(=[;{");
  if (brace == stop && brace != std::string_view::npos) {  // a block
    std::set<std::string> names;
    std::string_view members = text.substr(brace + 1, text.find('}') - brace - 1);
    while (!Trimmed(members).empty()) {
      const std::size_t end = std::min(members.find(';'), members.size());
      const std::string_view member = members.substr(0, end);
      names.insert(last_word(member.substr(0, std::min(member.find('['), member.size()))));
      members.remove_prefix(std::min(end + 1, members.size()));
    }
    return names;
  }
  return {last_word(text.substr(0, stop))};
}

}  // namespace

std::string_view Trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\n") - begin + 1);
}

std::string WithoutComments(std::string_view text) {
  std::string code;
  ForCode(text, [&](std::size_t begin, std::size_t end) { code += std::string(text.substr(begin, end - begin)) + " "; });
  return code;
}

std::set<std::string> Words(std::string_view code) {
  std::set<std::string> words;
  for (std::size_t i = 0; i < code.size();) {
    if (!IsWord(code[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < code.size() && IsWord(code[i])) ++i;
    if (IsWordStart(code[begin])) words.emplace(code.substr(begin, i - begin));
  }
  return words;
}

DecidedText Decide(const ExpandedSource& source) {
  DecidedText decided;
  std::map<std::string, std::string> macros;
  struct Open {
    bool taken, on, outer;
  };
  std::vector<Open> open;
  bool on = true;
  std::size_t number = 0;
  for (std::string_view rest = source.text; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const ExpandedSource::Origin& origin = source.origins.at(number);
    const std::string where = fmt::format("{}:{}", origin.file, origin.line);
    const bool host = origin.file == kHostFile;
    std::string_view directive = Trimmed(line);
    if (!directive.starts_with('#')) {
      if (on) decided.lines.push_back({std::string(line), origin.file});
      continue;
    }
    directive = Trimmed(directive.substr(1));
    const auto value = [&](std::string_view text) { return Condition(text.substr(0, text.find("//")), macros, where).Value(); };
    if (directive.starts_with("if")) {
      const bool now = on && value(directive.substr(2));
      open.push_back({now, now, on});
      on = now;
    } else if (directive.starts_with("elif")) {
      Open& last = open.back();
      on = last.on = last.outer && !last.taken && value(directive.substr(4));
      last.taken = last.taken || on;
    } else if (directive.starts_with("else")) {
      Open& last = open.back();
      on = last.on = last.outer && !last.taken;
    } else if (directive.starts_with("endif")) {
      on = open.back().outer;
      open.pop_back();
    } else if (directive.starts_with("define") && on) {
      const auto [name, definition] = Definition(directive);
      macros[name] = definition;
      if (host) {
        if (!definition.starts_with('(')) decided.host[name] = definition;
      } else {
        decided.lines.push_back({std::string(line), origin.file});
      }
    }
  }
  return decided;
}

std::vector<Declaration> Declarations(const std::vector<TextLine>& lines) {
  std::vector<Declaration> found;
  Declaration open;
  int depth = 0;
  bool in_block_comment = false;
  const auto close = [&] {
    if (!Trimmed(open.text).empty()) {
      const std::string code = WithoutComments(open.text);
      if (!Trimmed(code).empty()) {
        open.names = NamesOf(code);
        open.uses = Words(code);
      }
      found.push_back(std::move(open));
    }
    open = {};
  };
  for (const TextLine& line : lines) {
    if (depth == 0 && (open.file != line.file || Trimmed(line.text).empty())) close();
    if (depth == 0 && Trimmed(line.text).empty()) continue;
    open.file = line.file;
    open.text += line.text + "\n";
    if (in_block_comment || line.text.starts_with("/*")) {  // only a technique's header is one
      in_block_comment = line.text.find("*/") == std::string::npos;
      if (!in_block_comment) open = {};
      continue;
    }
    const std::string code = WithoutComments(line.text);
    for (const char c : code) depth += c == '{' || c == '(' ? 1 : c == '}' || c == ')' ? -1 : 0;
    const std::string_view end = Trimmed(code);
    if (depth == 0 && (end.ends_with(';') || end.ends_with('}') || end.starts_with('#'))) close();
  }
  close();
  return found;
}

std::string ReplaceWords(const std::string& text, const std::map<std::string, std::string>& by) {
  std::string result;
  std::size_t copied = 0;
  ForCode(text, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end;) {
      if (!IsWord(text[i])) {
        ++i;
        continue;
      }
      const std::size_t start = i;
      while (i < end && IsWord(text[i])) ++i;
      const auto found = by.find(text.substr(start, i - start));
      if (found == by.end()) continue;
      result += text.substr(copied, start - copied) + found->second;
      copied = i;
    }
  });
  return result + text.substr(copied);
}

}  // namespace arealab
