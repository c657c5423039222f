#include "glsl/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string_view>

#include "glsl/declarations.h"
#include "glsl/expand.h"
#include "glsl/words.h"
#include "scenes/error.h"

namespace arealab {
namespace {

// Calls of `name` become what `call(argument)` makes of what stands in their parentheses.
template <typename Call>
std::string ReplaceCalls(std::string text, const std::string& name, const Call& call) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::size_t open = at + name.size();
    if ((at > 0 && IsWord(text[at - 1])) || open >= text.size() || text[open] != '(') continue;
    std::size_t end = open + 1;
    for (int depth = 1; end < text.size() && depth > 0; ++end) depth += text[end] == '(' ? 1 : text[end] == ')' ? -1 : 0;
    const std::string argument = text.substr(open + 1, end - open - 2);
    const bool enclosed = at > 0 && text[at - 1] == '(' && end < text.size() && text[end] == ')';
    text.replace(at, end - at, call(argument, enclosed));
  }
  return text;
}

// A function that returns its one argument: what `arealab cost` hooks into. Its name, or nothing.
std::optional<std::string> Identity(const Declaration& declaration) {
  static const std::regex form("\\s*\\w+\\s+(\\w+)\\(\\w+ (\\w+)\\)\\s*\\{\\s*return (\\w+);\\s*\\}\\s*");
  std::smatch match;
  const std::string code = WithoutComments(declaration.text);
  if (!std::regex_match(code, match, form) || match[2] != match[3]) return std::nullopt;
  return match[1];
}

// What comments say of the file's place among ours means nothing outside.
std::string Outward(const std::string& text) {
  static const std::regex asides("[ \\t]*\\b(Dual\\b|After [^.\\n]*(\\.glsl|an? \"|the options?)|Not rewritten by|Set by glsl/)([^.\\n]|\\n//|\\.(?=[^\\s]))*\\.");
  static const std::regex empty_lines("(^|\\n)[ \\t]*//[ \\t]*(?=\\n[^/]|\\n$|$)");
  return std::regex_replace(std::regex_replace(text, asides, ""), empty_lines, "$1");
}

std::string Comment(const std::string& text) {
  constexpr std::size_t kWidth = 125;
  std::string lines, line = "//";
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (line.size() + 1 + end - begin > kWidth) {
      lines += line + "\n";
      line = "//  ";
    }
    line += " " + text.substr(begin, end - begin);
    begin = end + 1;
  }
  return lines + line + "\n";
}

std::string Heading(const Variant& variant, const std::vector<Effect>& effects, Brdfs brdfs) {
  const Technique& technique = *variant.technique;
  std::string on, off;
  for (const Effect& effect : effects) {
    const auto forced = variant.effects.find(effect.name);
    std::string& list = (forced == variant.effects.end() ? effect.on : forced->second) ? on : off;
    list += (list.empty() ? "" : ", ") + effect.name;
  }
  return Comment(variant.Name() + ": " + technique.summary + ".") + Comment("Source: " + technique.citation + ".") +
         Comment("Note: " + technique.author_note) + Comment(fmt::format("BRDF: {}, diffuse {}. With: {}. Without: {}.", Name(brdfs.specular), Name(brdfs.diffuse), on, off)) +
         "// From AreaLab's lighting pass. SPDX-License-Identifier: MIT. Copyright (c) 2026 The AreaLab authors.\n";
}

}  // namespace

ExportedShader ExportShader(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, Brdfs brdfs,
                            GlslDialect dialect, int lights) {
  const DecidedText decided = Decide(Expand(library, "lighting.frag", variant, Defines(effects, variant.effects), Precision::kFloat, brdfs));
  std::vector<Declaration> declarations = Declarations(decided.lines);

  // Backwards from main.
  std::map<std::string, std::vector<const Declaration*>> by_name;
  std::set<std::string> identities;
  for (const Declaration& declaration : declarations) {
    for (const std::string& name : declaration.names) by_name[name].push_back(&declaration);
    if (const auto name = Identity(declaration)) identities.insert(*name);
  }
  std::set<const Declaration*> used;
  std::vector<std::string> to_visit{"main"};
  while (!to_visit.empty()) {
    const std::string name = to_visit.back();
    to_visit.pop_back();
    for (const Declaration* declaration : by_name[name]) {
      if (identities.contains(name) || !used.insert(declaration).second) continue;
      to_visit.insert(to_visit.end(), declaration->uses.begin(), declaration->uses.end());
    }
  }
  std::set<std::string> used_files;
  for (const Declaration* declaration : used) used_files.insert(declaration->file);

  ExportedShader shader;
  shader.text = dialect == GlslDialect::kEs300
                    ? "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\nprecision highp sampler2DArray;\n"
                    : "#version 330 core\n";
  shader.text += Heading(variant, effects, brdfs) + "\n";
  static const std::regex binding("layout\\(binding = \\d+\\) |, binding = \\d+");
  static const std::regex capacity("(#define MAX_LIGHTS) \\d+");
  static const std::regex asserts("[ \\t]*\\bassert\\([^\\n]*\\);\\n");
  std::string file;
  for (const Declaration& declaration : declarations) {
    const bool opening = declaration.names.empty();
    if (opening ? !used_files.contains(declaration.file) : !used.contains(&declaration)) continue;
    std::string text = Outward(ReplaceWords(declaration.text, decided.host));
    for (const std::string& identity : identities) {
      text = ReplaceCalls(text, identity, [](const std::string& argument, bool enclosed) {
        return enclosed || argument.find(' ') == std::string::npos ? argument : "(" + argument + ")";
      });
    }
    text = ReplaceCalls(text, "INOUT", [](const std::string& type, bool) { return "inout " + type; });
    text = ReplaceCalls(text, "OUT", [](const std::string& type, bool) { return "out " + type; });
    text = ReplaceCalls(text, "IN", [](const std::string& type, bool) { return "in " + type; });
    text = std::regex_replace(text, asserts, "");
    text = std::regex_replace(text, binding, "");
    text = std::regex_replace(text, capacity, fmt::format("$1 {}", lights));
    if (Trimmed(text).empty()) continue;
    // Functions and structures stand apart, short lines of a file together.
    const bool tall = std::ranges::count(text, '\n') > 1 || declaration.file != file;
    if (tall && !shader.text.ends_with("\n\n")) shader.text += "\n";
    shader.text += text;
    if (tall) shader.text += "\n";
    file = declaration.file;
  }
  while (shader.text.ends_with("\n\n")) shader.text.pop_back();

  const std::set<std::string> words = Words(WithoutComments(shader.text));
  for (const Table& table : TablesOf(variant, brdfs)) {
    if (words.contains("table_" + table.name)) shader.tables.push_back(table.name);
  }
  for (const Knob& knob : variant.technique->knobs) {
    if (words.contains("knob_" + knob.name)) shader.knobs.push_back(knob.name);
  }
  static const std::regex array("uniform sampler2DArray (\\w+);");
  for (std::sregex_iterator found(shader.text.begin(), shader.text.end(), array), end; found != end; ++found) shader.light_textures.push_back((*found)[1]);
  return shader;
}

}  // namespace arealab
