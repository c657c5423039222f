#include "compare/stress_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "compare/cache_file.h"
#include "compare/content_hash.h"
#include "compare/page_parts.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

constexpr Rgb kMagenta{255, 0, 255};
// Of the colours: the logarithm of a rounding error from 1e-7, a float's own, to 1.
constexpr double kLeastError = 1e-7;

double ErrorTone(double error) {
  return std::log10(std::max(error, kLeastError) / kLeastError) / 7.0;
}

Rgb ErrorColor(double error) {
  return std::isfinite(error) ? Color(kMagnitude, ErrorTone(error)) : kMagenta;
}

std::string Css(const Rgb& c) {
  return fmt::format("rgb({} {} {})", c[0], c[1], c[2]);
}

std::string Anchor(std::size_t variant, const FamilyResult& family) {
  return fmt::format("v{}-{}", variant, family.family->name);
}

std::string SceneFile(const VariantStress& variant, const FamilyResult& family) {
  std::string folder = variant.name;
  std::replace(folder.begin(), folder.end(), '@', '_');
  return fmt::format("cases/{}/{}.toml", folder, family.family->name);
}

std::string SceneOf(const VariantStress& variant, const FamilyResult& family) {
  return CaseScene(family.worst_case, fmt::format("{}: {}", variant.name, family.family->sentence));
}

std::string InAddress(const std::string& text) {
  std::string address;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || std::string_view("-._~,=:/[]").find(c) != std::string_view::npos;
    address += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return address;
}

std::string Ramp() {
  std::string stops;
  constexpr int kStops = 14;
  for (int i = 0; i <= kStops; ++i)
    stops += fmt::format("{}{}", i == 0 ? "" : ", ", Css(Color(kMagnitude, i / double{kStops})));
  return fmt::format("<span class=\"ramp\" style=\"background: linear-gradient(90deg, {})\"></span>", stops);
}

// One row a variant, one column a family.
std::string Matrix(const StressResult& result) {
  std::string html = "<div class=\"scroll\"><table><thead><tr><th></th>";
  for (const StressFamily& family : StressFamilies())
    html += fmt::format("<th class=\"column\" title=\"{}\"><span>{}{}</span></th>", Escaped(family.sentence),
                        family.name, family.ill_conditioned ? " *" : "");
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t v = 0; v < result.variants.size(); ++v) {
    const VariantStress& variant = result.variants[v];
    html += fmt::format("<tr><th class=\"name\">{}{}</th>", Escaped(variant.name),
                        variant.judged ? "" : " <i>shown</i>");
    for (const StressFamily& family : StressFamilies()) {
      const auto found = std::ranges::find(variant.families, &family, &FamilyResult::family);
      if (found == variant.families.end()) {
        html += "<td class=\"none\">–</td>";
        continue;
      }
      const bool lost = found->nonfinite > 0;
      const Rgb color = lost ? kMagenta : ErrorColor(found->worst);
      html += fmt::format(
          "<td><a href=\"#{}\" style=\"background: {}; color: {}\" title=\"{}\">{}{}</a></td>",
          Anchor(v, *found), Css(color), lost || ErrorTone(found->worst) < 0.62 ? "#fff" : "#17191d",
          Escaped(fmt::format("{}: worst rounding error {:.2g}, {:.2g} at 99.9 %", family.name, found->worst,
                              found->p999)),
          lost ? "NaN" : fmt::format("{:.0e}", found->worst), found->failures.empty() ? "" : " ✕");
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string Detail(const StressResult& result, std::size_t v, const FamilyResult& family) {
  const VariantStress& variant = result.variants[v];
  std::string html =
      fmt::format("<details id=\"{}\"><summary>{}: <b>{}</b>{}</summary>\n<p class=\"note\">{}.</p>\n",
                  Anchor(v, family), Escaped(variant.name), family.family->name,
                  family.failures.empty() ? "" : " ✕", Escaped(family.family->sentence));
  for (const std::string& failure : family.failures)
    html += fmt::format("<p class=\"failure\">{}</p>\n", Escaped(failure));
  html += fmt::format(
      "<p>{} cases: {} not finite ({} where min and max pass a NaN on), {} negative; rounding error {:.2g} "
      "at 99.9 %, {:.2g} at "
      "worst; backward error {:.2g} ulps{}; from the ideal form {:.2g}; half-float tables {:.2g}{}.</p>\n",
      family.cases, family.nonfinite, family.hidden, family.negative, family.p999, family.worst,
      family.backward, family.family->ill_conditioned ? " (what it is judged by)" : "", family.approximation,
      family.half_tables,
      family.fp16_cases == 0 ? ""
                             : fmt::format("; fp16: {} of {} not finite, {:.2g} at 99.9 %", family.fp16_nonfinite,
                                           family.fp16_cases, family.fp16_p999));
  if (!family.cause.empty()) {
    html +=
        fmt::format("<p class=\"note\">Looser bounds, {:g}, {:g} and {:g} ulps: {}.</p>\n",
                    family.bounds.worst, family.bounds.p999, family.bounds.backward, Escaped(family.cause));
  }
  if (!family.patch_value.empty()) {
    html += "<div class=\"pictures\">";
    for (const HardPicture& picture : HardPictures(family)) html += FigureHtml(picture.pixels, kPatch, picture.caption);
    html += "</div>";
  }
  html += fmt::format(
      "<pre>arealab stress --technique '{}' --case '{}'</pre>\n<p><a download=\"{}-{}.toml\" href=\"data:text/plain;charset=utf-8,{}\">as a "
      "scene</a></p>\n</details>\n",
      Escaped(variant.name), CaseLine(family.worst_case), Escaped(variant.name), family.family->name, InAddress(SceneOf(variant, family)));
  return html;
}

// value − ideal over the ideal's greatest, drawn along the path.
std::string Curve(const PathResult& path) {
  double most = 1e-30, spread = 1e-12;
  for (const float v : path.ideal) most = std::max(most, static_cast<double>(v));
  for (std::size_t i = 0; i < path.value.size(); ++i)
    spread = std::max(spread, std::abs(static_cast<double>(path.value[i] - path.ideal[i])) / most);
  const auto line = [&](auto&& height) {
    std::string points;
    for (std::size_t i = 0; i < path.value.size(); i += 4)
      points += fmt::format("{:.1f},{:.1f} ", 300.0 * static_cast<double>(i) / (kPathPoints - 1), height(i));
    return points;
  };
  return fmt::format(
      "<figure><svg viewBox=\"0 0 300 90\" role=\"img\" aria-label=\"{0} {1}\"><path d=\"M0 45H300\" "
      "class=\"axis\"/>"
      "<polyline class=\"value\" points=\"{2}\"/><polyline class=\"error\" points=\"{3}\"/></svg>"
      "<figcaption>{0}, {4}, {1}: step {5:.1e}, bend {6:.1e}{7}; the error's height is {8:.1e} of the "
      "greatest</figcaption></figure>\n",
      path.path->name, path.lobe,
      line([&](std::size_t i) { return 88.0 - 86.0 * std::clamp(path.value[i] / most, 0.0, 1.0); }),
      line([&](std::size_t i) { return 45.0 - 43.0 * (path.value[i] - path.ideal[i]) / most / spread; }),
      Name(path.shape), path.step, path.bend, path.failures.empty() ? "" : " ✕", spread);
}

std::string Paths(const VariantStress& variant) {
  std::string html = fmt::format(
      "<details><summary>{}{}</summary><div class=\"curves\">\n", Escaped(variant.name),
      std::ranges::any_of(variant.paths, [](const PathResult& p) { return !p.failures.empty(); }) ? " ✕"
                                                                                                  : "");
  for (const PathResult& path : variant.paths) {
    if (path.shape == variant.paths[0].shape) html += Curve(path);
  }
  return html + "</div></details>\n";
}

std::string LowerPrecision(const StressResult& result) {
  std::string rows;
  const auto share = [](std::int64_t part, std::int64_t whole) {
    return part == 0 ? std::string("0") : fmt::format("{:.2g} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
  };
  for (const VariantStress& variant : result.variants) {
    const auto ordinary = std::ranges::find(variant.families, &StressFamilies()[0], &FamilyResult::family);
    if (ordinary == variant.families.end() || variant.fp16_cases() == 0) continue;
    rows += fmt::format("<tr><th class=\"name\">{}</th><td>{:.1e}</td><td>{}</td><td>{:.1e}</td><td>{:.1e}</td><td>{}</td></tr>\n", Escaped(variant.name),
                        ordinary->half_tables, share(ordinary->fp16_nonfinite, ordinary->fp16_cases), ordinary->fp16_median, ordinary->fp16_p999,
                        share(variant.fp16_nonfinite(), variant.fp16_cases()));
  }
  if (rows.empty()) return {};
  return "<h2>Lower precision</h2>\n<p class=\"note\">Half-float tables: the error that they add, at 99.9 %. fp16: the same text with every input and "
         "every result a half float (nearest, infinite from 65520, 0 below 6.1e-5), against float on the same inputs; ordinary lights, and in the last "
         "column every family. Told, not judged.</p>\n<div class=\"scroll\"><table class=\"figures\"><thead><tr><th></th><th>half tables</th><th>fp16 not finite</th>"
         "<th>median</th><th>99.9 %</th><th>not finite, all families</th></tr></thead>\n<tbody>\n" + rows + "</tbody></table></div>\n";
}

constexpr const char* kStressStyle = R"(
:root { color-scheme: light dark; --line: #8885; --accent: light-dark(#9a4a00, #ffb866); --warn: light-dark(#b3261e, #ff8a80); }
body { margin: 2rem auto; width: min(100% - 2rem, 92rem); font: 15px/1.55 system-ui, "Segoe UI", Roboto, "Noto Sans", Arial, sans-serif; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
h1 { font-size: 1.9rem; letter-spacing: -.02em; margin: 0 0 .5rem; } h2 { margin: 2.2rem 0 .6rem; font-size: 1.25rem; }
a { color: var(--accent); } .note { opacity: .8; max-width: 92ch; margin: .3rem 0; } .failure { color: var(--warn); margin: .2rem 0; }
.scroll { overflow-x: auto; } table { border-collapse: separate; border-spacing: 1px; font-size: .7rem; } table.figures { font-size: .78rem; }
th { font-weight: 500; text-align: left; white-space: nowrap; padding-right: .6rem; } th i { opacity: .6; font-size: .9em; }
th.column { vertical-align: bottom; padding: 0; height: 7rem; } th.column span { writing-mode: vertical-rl; transform: rotate(180deg); }
td { padding: 0; min-width: 2.35rem; text-align: center; } td.none { opacity: .4; }
.figures td, .figures th { padding: .2rem .8rem .2rem 0; text-align: left; }
td a { display: block; padding: .22rem .05rem; border-radius: 4px; text-decoration: none; white-space: nowrap; }
td a:hover { outline: 2px solid var(--accent); }
details { border-top: 1px solid var(--line); padding: .35rem 0; } summary { cursor: pointer; } details:target { outline: 2px solid var(--accent); outline-offset: 4px; border-radius: 4px; }
pre { padding: .6rem .8rem; background: #8882; border-radius: 4px; white-space: pre-wrap; font-size: .82rem; }
figure { margin: 0; } figcaption { font-size: .8rem; opacity: .8; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, 14rem); gap: 1rem; } .pictures img { width: 100%; height: auto; image-rendering: pixelated; display: block; }
.curves { display: grid; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); gap: 1rem; margin-top: .6rem; }
svg { width: 100%; background: #8881; border-radius: 4px; } .axis { stroke: #8886; } polyline { fill: none; vector-effect: non-scaling-stroke; }
.value { stroke: #8889; } .error { stroke: var(--warn); stroke-width: 1.5; }
.unbroken { white-space: nowrap; } .ramp { display: inline-block; width: 14rem; height: .8rem; margin: 0 .5rem; vertical-align: middle; border-radius: 3px; }
)";

// Opens the cell that was asked for.
constexpr const char* kScript = R"(
const show = () => { const at = document.getElementById(location.hash.slice(1)); if (at) { at.open = true; at.scrollIntoView({block: "center"}); } };
addEventListener("hashchange", show); show();
)";

}  // namespace

std::vector<HardPicture> HardPictures(const FamilyResult& family) {
  float most = 0.0f;
  for (const float v : family.patch_double) {
    if (std::isfinite(v)) most = std::max(most, v);
  }
  const auto shown = [&](const std::vector<float>& values) {
    std::vector<Rgb> pixels;
    for (const float v : values) {
      Rgb code = kMagenta;
      if (std::isfinite(v)) {
        const double linear = most > 0.0f ? std::clamp(static_cast<double>(v / most), 0.0, 1.0) : 0.0;
        code.fill(static_cast<std::uint8_t>(std::lround(255.0 * std::pow(linear, 1.0 / 2.2))));
      }
      pixels.push_back(code);
    }
    return pixels;
  };
  std::vector<Rgb> error;
  for (const float e : family.patch_error) error.push_back(ErrorColor(e));
  std::vector<HardPicture> pictures{
      {"result", fmt::format("in float; white is {:.2g} of the light", most), shown(family.patch_value)}};
  const bool seen = std::ranges::any_of(family.patch_error, [](float e) { return !(e < 1e-2f); });
  if (seen || !family.failures.empty())
    pictures.push_back({"reference", "the same text in double", shown(family.patch_double)});
  pictures.push_back({"difference", "rounding error, 1e-7 to 1", std::move(error)});
  return pictures;
}

std::string StressPage(const StressResult& result, const std::string& report) {
  const int failures = result.failures();
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">"
      "<title>AreaLab: hard cases</title>\n<style>{}</style></head>\n<body>\n{}<h1>Hard cases</h1>\n"
      "<p>{} cases of each technique, seed {}, {}. {}</p>\n"
      "<p class=\"note\">Colour and figure: the worst rounding error, |float − the same text in double| over "
      "the larger of the value "
      "and what the light gives at most. <span class=\"unbroken\">1e-7 {} 1.</span> Magenta: not finite. ✕: a bound is exceeded; forms that "
      "are only shown are their "
      "authors', and may. *: an input's last bit moves the answer, and "
      "what is judged is how many of the inputs' ulps explain the error. A cell opens its worst case.</p>\n",
      kStressStyle, report.empty() ? "" : fmt::format("<p><a href=\"{}\">the report</a></p>\n", report), result.cases,
      result.seed, Escaped(result.renderer),
      failures == 0 ? "Every form that is judged keeps its bounds."
                    : fmt::format("{} bounds exceeded.", failures),
      Ramp());
  html += Matrix(result);
  html += LowerPrecision(result);
  html +=
      "<h2>Along paths</h2>\n<p class=\"note\">Grey: the value. Red: its difference from the ideal form, "
      "exact in double, "
      "drawn to the figure's height. Ringing is a wave in it, banding a row of kinks.</p>\n";
  for (const VariantStress& variant : result.variants) {
    if (!variant.paths.empty()) html += Paths(variant);
  }
  html += "<h2>Worst cases</h2>\n";
  for (std::size_t v = 0; v < result.variants.size(); ++v) {
    for (const FamilyResult& family : result.variants[v].families) html += Detail(result, v, family);
  }
  return html + fmt::format("<script>{}</script>\n</body>\n</html>\n", kScript);
}

void WriteStressPage(const StressResult& result, const fs::path& folder) {
  for (const VariantStress& variant : result.variants) {
    for (const FamilyResult& family : variant.families) ReplaceFile(folder / SceneFile(variant, family), SceneOf(variant, family));
  }
  ReplaceFile(folder / "stress.html", StressPage(result, ""));
}

HardCasesPage CachedStressPage(Context& context, const ShaderLibrary& library, const StressOptions& options, const std::string& report,
                               const fs::path& cache) {
  ContentHash hash;
  hash.Program();
  hash.Text(context.renderer() + context.version() + report);
  hash.Value(options.cases);
  hash.Value(options.seed);
  hash.Value(options.fp16);
  for (const Variant& variant : options.variants) hash.Text(variant.Name());
  const std::string name = hash.Name() + ".hard-cases";
  HardCasesPage page;
  page.techniques = static_cast<int>(options.variants.size());
  page.cases = options.cases;
  if (const auto entry = ReadCacheEntry(cache, name)) {
    const std::size_t line = entry->find('\n');
    page.failures = std::atoi(entry->c_str());
    page.html = entry->substr(line + 1);
    return page;
  }
  const StressResult result = Stress(context, library, options);
  page.failures = result.failures();
  page.html = StressPage(result, report);
  WriteCacheEntry(cache, name, fmt::format("{}\n{}", page.failures, page.html));
  return page;
}

}  // namespace arealab
