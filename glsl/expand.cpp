#include "glsl/expand.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <string_view>

#include "glsl/fp16_rewrite.h"
#include "glsl/fp64_rewrite.h"
#include "glsl/nearest.h"
#include "glsl/words.h"
#include "scenes/error.h"

namespace arealab {

namespace {

std::vector<std::string_view> SplitLines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// Whether a block comment is open after `line`, given whether one was before.
bool CommentOpenAfter(std::string_view line, bool open) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const std::string_view pair = line.substr(i, 2);
    if (!open && pair == "//") return false;
    if (pair == (open ? "*/" : "/*")) {
      open = !open;
      ++i;
    }
  }
  return open;
}

std::string_view TrimLeft(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view{} : text.substr(begin);
}

// If `line` is the directive `#NAME`, what follows the name.
std::optional<std::string_view> AfterDirective(std::string_view line, std::string_view name) {
  line = TrimLeft(line);
  if (!line.starts_with('#')) return std::nullopt;
  line = TrimLeft(line.substr(1));
  if (!line.starts_with(name)) return std::nullopt;
  line.remove_prefix(name.size());
  if (!line.empty() && (std::isalnum(static_cast<unsigned char>(line[0])) || line[0] == '_'))
    return std::nullopt;
  return TrimLeft(line);
}

class Expander {
 public:
  Expander(const ShaderLibrary& library, const Variant& variant, Precision precision, Brdfs brdfs)
      : library_(library), variant_(variant), precision_(precision), brdfs_(brdfs) {}

  ExpandedSource Run(const std::string& main, const std::vector<std::pair<std::string, int>>& effects) {
    EmitPrologue(effects);
    if (precision_ != Precision::kFloat) {
      Include(precision_ == Precision::kDouble ? "fp64_math.glsl" : "fp16_math.glsl",
              fmt::format("{}:1", library_.DisplayPath(main)));
    }
    if (!library_.Find(main))
      throw InputError(fmt::format("{}: no such shader; expected a file under glsl/", main));
    Include(main, "");
    return std::move(out_);
  }

 private:
  void Emit(std::string_view line, const ExpandedSource::Origin& origin) {
    out_.text += line;
    out_.text += '\n';
    out_.origins.push_back(origin);
  }

  void EmitHost(std::string_view line) {
    Emit(line, {std::string(kHostFile), static_cast<int>(out_.origins.size()) + 1});
  }

  void EmitPrologue(const std::vector<std::pair<std::string, int>>& effects) {
    EmitHost("#version 450 core");
    const bool is_double = precision_ == Precision::kDouble;
    EmitHost(fmt::format("#define AREALAB_FLOAT {}", is_double ? 0 : 1));
    EmitHost(fmt::format("#define AREALAB_DOUBLE {}", is_double ? 1 : 0));
    EmitHost("#define AREALAB_DUAL 0");  // 1 where shader text compiles as C++: glsl/dual_begin.h
    EmitHost("#define IN(type) in type");
    EmitHost("#define OUT(type) out type");
    EmitHost("#define INOUT(type) inout type");
    EmitHost("#define assert(condition)");
    for (const auto& [name, value] : effects) EmitHost(fmt::format("#define {} {}", name, value));
    for (const Brdf brdf : kDiffuseBrdfs) EmitHost(fmt::format("#define DIFFUSE_{} {}", Upper(Name(brdf)), brdf == brdfs_.diffuse ? 1 : 0));
    // Which answers to assume: none but where the host asks (glsl/lit.glsl, glsl/path.glsl).
    for (const std::string_view path : {"PATH_LIT", "PATH_ABOVE", "PATH_CROSSING", "PATH_BELOW", "PATH_FAR", "PATH_NEAR"}) {
      const auto named = [&](const auto& effect) { return effect.first == path; };
      if (std::none_of(effects.begin(), effects.end(), named)) EmitHost(fmt::format("#define {} 0", path));
    }
    if (!variant_.technique) return;
    for (const Option& option : variant_.technique->options) {
      for (const Choice& choice : option.choices) {
        const int chosen = variant_.options.at(option.name) == choice.name ? 1 : 0;
        EmitHost(fmt::format("#define {}_{} {}", Upper(option.name), Upper(choice.name), chosen));
      }
    }
    for (const Knob& knob : variant_.technique->knobs)
      EmitHost(fmt::format("uniform float knob_{};", knob.name));
    for (const Table& table : TablesOf(variant_, brdfs_)) {
      EmitHost(fmt::format("uniform sampler2D table_{};", table.name));
    }
  }

  bool Takes(const char* effect) const { return std::ranges::find(variant_.technique->effects, effect) != variant_.technique->effects.end(); }

  // The library's name for what an #include says.
  std::string Resolve(const std::string& name) const {
    if (name == "platform") {
      return precision_ == Precision::kDouble ? "platform_double.glsl"
             : precision_ == Precision::kHalf ? "platform_half.glsl"
                                              : "platform_float.glsl";
    }
    if (name == "brdf" || name == "importance_cone" || name == "specular_albedo") return fmt::format("{}/{}.glsl", name, Name(brdfs_.specular));
    if (name == "diffuse") return fmt::format("{}/{}.glsl", name, Name(brdfs_.diffuse));
    if (!variant_.technique) return name;
    // What the pass does where the technique does not take it itself.
    if (name == "visibility") return Takes("aperture") ? "visibility/own.glsl" : "visibility/aperture.glsl";
    if (name == "sky") return Takes("sky") ? "sky/own.glsl" : "sky/fill.glsl";
    if (name == "technique") return fmt::format("techniques/{}.glsl", variant_.technique->name);
    const auto option = variant_.options.find(name);
    return option == variant_.options.end() ? name : fmt::format("{}/{}.glsl", name, option->second);
  }

  [[noreturn]] void FailUnknown(const std::string& name, const std::string& resolved,
                                const std::string& where) const {
    std::vector<std::string> special{"\"platform\"", "\"brdf\"", "\"diffuse\""};
    if (variant_.technique) {
      special.emplace_back("\"technique\"");
      for (const Option& option : variant_.technique->options)
        special.push_back(fmt::format("\"{}\"", option.name));
    }
    const std::string as = name == resolved ? "" : fmt::format(" (glsl/{})", resolved);
    throw InputError(fmt::format("{}: unknown include \"{}\"{}; expected a file under glsl/ or {}", where,
                                 name, as, fmt::join(special, ", ")));
  }

  void CheckCycle(const std::string& file, const std::string& where) const {
    const auto first = std::find(open_.begin(), open_.end(), file);
    if (first == open_.end()) return;
    std::string chain;
    for (auto step = first; step != open_.end(); ++step) chain += *step + " -> ";
    throw InputError(fmt::format("{}: includes go in a circle: {}{}; expected none", where, chain, file));
  }

  // `where`: file:line of the directive.
  void Include(const std::string& name, const std::string& where) {
    const std::string file = Resolve(name);
    CheckCycle(file, where);
    if (included_.contains(file)) return;
    std::optional<std::string> text = library_.Find(file);
    if (!text) FailUnknown(name, file, where);
    included_.insert(file);
    open_.push_back(file);
    const bool rewritten = !file.starts_with("platform_") && !file.starts_with("fp64_") && !file.starts_with("fp16_");
    if (rewritten && precision_ == Precision::kDouble) *text = RewriteAsDouble(*text);
    if (rewritten && precision_ == Precision::kHalf) *text = RewriteAsHalf(*text);
    EmitFile(*text, library_.DisplayPath(file));
    open_.pop_back();
  }

  void EmitFile(std::string_view text, const std::string& path) {
    bool in_comment = false;
    int number = 0;
    for (const std::string_view line : SplitLines(text)) {
      ++number;
      const bool commented = in_comment;
      in_comment = CommentOpenAfter(line, in_comment);
      const ExpandedSource::Origin origin{path, number};
      if (commented) {
        Emit(line, origin);
      } else if (const auto included = AfterDirective(line, "include")) {
        Include(QuotedName(*included, origin), fmt::format("{}:{}", path, number));
      } else if (AfterDirective(line, "version")) {
        throw InputError(fmt::format("{}:{}: #version; expected none, the host writes it", path, number));
      } else if (const auto pragma = AfterDirective(line, "pragma");
                 !pragma || !pragma->starts_with("once")) {
        Emit(line, origin);
      }
    }
  }

  static std::string QuotedName(std::string_view text, const ExpandedSource::Origin& origin) {
    const auto end = text.find('"', 1);
    if (!text.starts_with('"') || end == std::string_view::npos || end == 1) {
      throw InputError(
          fmt::format("{}:{}: malformed include; expected #include \"NAME\"", origin.file, origin.line));
    }
    return std::string(text.substr(1, end - 1));
  }

  const ShaderLibrary& library_;
  const Variant& variant_;
  Precision precision_;
  Brdfs brdfs_;
  ExpandedSource out_;
  std::set<std::string> included_;
  std::vector<std::string> open_;  // from the main file to the one being read
};

// Digits at `at`; their end.
std::size_t SkipDigits(std::string_view text, std::size_t at) {
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at]))) ++at;
  return at;
}

// A place in a driver's log: the text [begin, end) stands for `line` of the source.
struct LogPlace {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t line = 0;
};

// Reads a place at `begin`: "0:LINE(COLUMN)" (Mesa), "0(LINE)" (NVIDIA), "0:LINE" (glslang, AMD, Intel).
std::optional<LogPlace> ReadPlace(std::string_view log, std::size_t begin) {
  constexpr std::size_t kMostDigits = 9;  // a line number that fits an int
  const bool inside_word =
      begin > 0 && (std::isalnum(static_cast<unsigned char>(log[begin - 1])) || log[begin - 1] == '.');
  if (inside_word || log[begin] != '0' || begin + 1 >= log.size()) return std::nullopt;
  const char separator = log[begin + 1];
  if (separator != ':' && separator != '(') return std::nullopt;
  std::size_t end = SkipDigits(log, begin + 2);
  const std::size_t digits = end - begin - 2;
  if (digits == 0 || digits > kMostDigits) return std::nullopt;
  const std::size_t line = std::stoul(std::string(log.substr(begin + 2, digits)));
  if (separator == '(') {
    if (end >= log.size() || log[end] != ')') return std::nullopt;
    return LogPlace{begin, end + 1, line};
  }
  if (end < log.size() && log[end] == '(') {
    const std::size_t close = SkipDigits(log, end + 1);
    if (close > end + 1 && close < log.size() && log[close] == ')') end = close + 1;
  }
  return LogPlace{begin, end, line};
}

// One line of a log. Its first place is the error's own; drivers put "ERROR: " before or nothing.
std::string RewriteLogLine(std::string_view line, const std::vector<ExpandedSource::Origin>& origins) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::optional<LogPlace> place = ReadPlace(line, i);
    if (!place || place->line == 0 || place->line > origins.size()) continue;
    const ExpandedSource::Origin& origin = origins[place->line - 1];
    std::string_view head = line.substr(0, place->begin);
    std::string_view tail = TrimLeft(line.substr(place->end));
    if (tail.starts_with(':')) tail = TrimLeft(tail.substr(1));
    // "ERROR: 0:12: what" becomes "file:7: error: what": the place first, as compilers write it.
    std::string kind;
    if (head == "ERROR: " || head == "WARNING: ") {
      kind = head == "ERROR: " ? "error: " : "warning: ";
      head = {};
    }
    return fmt::format("{}{}:{}: {}{}", head, origin.file, origin.line, kind, tail);
  }
  return std::string(line);
}

}  // namespace

std::string ExpandedSource::RewriteLog(const std::string& log) const {
  std::string rewritten;
  for (const std::string_view line : SplitLines(log)) rewritten += RewriteLogLine(line, origins) + '\n';
  if (!log.ends_with('\n') && !rewritten.empty()) rewritten.pop_back();
  return rewritten;
}

ExpandedSource Expand(const ShaderLibrary& library, const std::string& main, const Variant& variant,
                      const std::vector<std::pair<std::string, int>>& effects, Precision precision,
                      Brdfs brdfs) {
  return Expander(library, variant, precision, brdfs).Run(main, effects);
}

}  // namespace arealab
