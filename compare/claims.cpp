#include "compare/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "compare/cache_file.h"
#include "compare/content_hash.h"
#include "compare/page_parts.h"
#include "glsl/variant.h"
#include "scenes/error.h"

namespace arealab {

ClaimBench::ClaimBench(Context& context, const ShaderLibrary& library, const CostMeter* cost)
    : library_(library), techniques_(LoadTechniques(library)), shader_(context, library), cost_(cost) {}

std::vector<Shaded> ClaimBench::Shade(const std::string& variant, const std::vector<PointCase>& cases, Precision precision, Brdfs brdfs) {
  PointOptions options;
  options.precision = precision;
  options.brdfs = brdfs;
  return shader_.Shade(ParseVariant(techniques_, variant), cases, options);
}

GpuCost ClaimBench::Cost(const std::string& variant, const std::string& shape) const {
  const Scene scene = SceneOfEffects({shape, "diffuse", "specular", "fresnel"});
  return cost_->Measure(library_, {ParseVariant(techniques_, variant)}, scene).at(0).at("bonaire");
}

std::vector<ClaimSource> ClaimSources(const std::string& name) {
  const std::vector<ClaimSource> all = {HillClaims(), MayauxClaims(), LightFieldClaims(), DrobotClaims(), OatClaims()};
  if (name.empty()) return all;
  std::string known;
  for (const ClaimSource& source : all) {
    if (source.name == name) return {source};
    known += (known.empty() ? "" : ", ") + source.name;
  }
  throw InputError(fmt::format("--source {}: no such source; expected one of {}", name, known));
}

bool IsFrom(const Technique& technique, const ClaimSource& source) {
  return ("; " + technique.citation).find("; " + source.citation) != std::string::npos;
}

std::vector<CheckedClaim> CheckClaims(const ClaimSource& source, ClaimBench& bench) {
  std::vector<CheckedClaim> checked;
  for (const Claim& claim : source.claims) {
    Finding unknown;
    unknown.note = "Needs the compilers of `arealab cost`.";
    checked.push_back({claim, claim.needs_cost && !bench.has_cost() ? unknown : claim.compute(bench)});
  }
  return checked;
}

std::string VerdictText(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds: return "holds";
    case Verdict::kPartly: return "holds partly";
    case Verdict::kFails: return "does not hold";
    case Verdict::kUnknown: return "not measured";
  }
  return "";
}

namespace {

// Three figures, as people write them.
std::string ClaimNumber(double v) {
  if (!std::isfinite(v)) return "not finite";
  const double size = std::abs(v);
  if (size != 0.0 && (size < 1e-3 || size >= 1e5)) return fmt::format("{:.1e}", v);
  return fmt::format("{:.{}f}", v, size >= 100.0 ? 0 : size >= 10.0 ? 1 : size >= 1.0 ? 2 : 3);
}

std::string FigureText(const ClaimFigure& figure) {
  return ClaimNumber(figure.value) + (figure.unit.empty() ? "" : " " + figure.unit);
}

// About five round steps over a range.
std::vector<double> PlotTicks(double low, double high) {
  const double raw = (high - low) / 5.0, power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= raw) step = factor * power;
  }
  std::vector<double> ticks;
  for (double t = std::ceil(low / step - 1e-9) * step; t <= high + 1e-9 * step; t += step) ticks.push_back(std::abs(t) < 1e-9 * step ? 0.0 : t);
  return ticks;
}

std::string PlotSvg(const ClaimPlot& plot) {
  double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
  for (const ClaimCurve& curve : plot.curves) {
    for (const auto& [x, y] : curve.points) {
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  }
  if (!(x1 > x0)) return "";
  if (!(y1 > y0)) y1 = y0 + 1.0;
  const double margin = 0.04 * (y1 - y0);
  y0 -= margin, y1 += margin;
  constexpr double kWidth = 520.0, kHeight = 250.0, kLeft = 74.0, kRight = 508.0, kTop = 12.0, kBottom = 204.0;
  const auto place_x = [&](double x) { return kLeft + (x - x0) / (x1 - x0) * (kRight - kLeft); };
  const auto place_y = [&](double y) { return kBottom - (y - y0) / (y1 - y0) * (kBottom - kTop); };
  std::string svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} over {}\">", kWidth, kHeight, Escaped(plot.y), Escaped(plot.x));
  for (const double t : PlotTicks(x0, x1)) {
    svg += fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:.4g}</text>", place_x(t), kTop, kBottom, kBottom + 16, t);
  }
  for (const double t : PlotTicks(y0, y1)) {
    svg += fmt::format("<path class=\"grid\" d=\"M{1} {0:.1f}H{2}\"/><text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:.6g}</text>", place_y(t), kLeft, kRight, kLeft - 6, place_y(t) + 4, t);
  }
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    svg += fmt::format("<polyline class=\"c{}\" points=\"", c);
    for (const auto& [x, y] : plot.curves[c].points) {
      if (std::isfinite(x) && std::isfinite(y)) svg += fmt::format("{:.1f},{:.1f} ", place_x(x), place_y(y));
    }
    svg += "\"/>";
  }
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", (kLeft + kRight) / 2, kBottom + 38, Escaped(plot.x));
  svg += fmt::format("<text transform=\"translate(12 {}) rotate(-90)\" text-anchor=\"middle\">{}</text></svg>", (kTop + kBottom) / 2, Escaped(plot.y));
  std::string legend;
  for (std::size_t c = 0; c < plot.curves.size(); ++c) legend += fmt::format("<span class=\"key k{}\">{}</span>", c, Escaped(plot.curves[c].name));
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>", svg, legend);
}

constexpr const char* kClaimsStyle = R"(
:root { color-scheme: light dark; --ink: #16181d; --soft: #5b6270; --page: #fbfbfa; --card: #fff; --line: #dfe1e5; --good: #1a7f4b; --part: #a86400; --bad: #c02a37; --c0: #1f6fd1; --c1: #d9661f; --c2: #7a4fc0; }
@media (prefers-color-scheme: dark) { :root { --ink: #e7e9ee; --soft: #9aa2b1; --page: #111318; --card: #191c23; --line: #2c313c; --good: #58c98c; --part: #e0a64a; --bad: #f2717c; --c0: #6bb0ff; --c1: #ff9b57; --c2: #b998f5; } }
* { box-sizing: border-box; } body { margin: 0 auto; padding: 2.2rem 1.2rem 4rem; max-width: 76rem; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: clamp(1.5rem, 4vw, 2.1rem); line-height: 1.2; letter-spacing: -.015em; margin: .2rem 0 .4rem; } .lede { color: var(--soft); max-width: 46rem; margin: 0 0 1.6rem; }
nav { display: flex; flex-wrap: wrap; gap: .4rem 1.1rem; font-size: .9rem; margin-bottom: 1.4rem; } a { color: var(--c0); }
article { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: .4rem 2rem; background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 1.2rem 1.4rem; margin: 0 0 1rem; }
article > div, article > figure { min-width: 0; } article.plain { grid-template-columns: minmax(0, 1fr); }
h2 { font-size: 1.08rem; font-weight: 600; line-height: 1.4; margin: .15rem 0 .7rem; } .where { color: var(--soft); font-size: .82rem; }
.verdict { display: inline-block; font-weight: 650; font-size: .84rem; padding: .1rem .6rem; border-radius: 99px; border: 1.5px solid; margin-right: .6rem; }
.v0 { color: var(--good); } .v1 { color: var(--part); } .v2 { color: var(--bad); } .v3 { color: var(--soft); }
dl { display: grid; grid-template-columns: minmax(0, 1fr) auto; gap: .25rem 1rem; margin: .4rem 0 .8rem; } dt { color: var(--soft); } dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; font-weight: 600; }
.note, .rule { font-size: .88rem; color: var(--soft); margin: .3rem 0; } code { font: .8rem/1.45 ui-monospace, monospace; display: block; overflow-wrap: anywhere; background: color-mix(in srgb, var(--line) 45%, transparent); border-radius: 6px; padding: .4rem .6rem; margin-top: .6rem; }
figure { margin: 0; } svg { width: 100%; height: auto; display: block; } svg text { font-size: 12px; fill: var(--soft); } .grid { stroke: var(--line); fill: none; } polyline { fill: none; stroke-width: 1.8; }
.c0 { stroke: var(--c0); } .c1 { stroke: var(--c1); } .c2 { stroke: var(--c2); } figcaption { font-size: .85rem; padding-left: .4rem; } .key { margin-right: 1.1rem; white-space: nowrap; } .key::before { content: ""; display: inline-block; width: 1.3em; height: 3px; vertical-align: middle; margin-right: .4em; background: currentColor; border-radius: 2px; }
.k0::before { background: var(--c0); } .k1::before { background: var(--c1); } .k2::before { background: var(--c2); }
@media (max-width: 760px) { article { grid-template-columns: minmax(0, 1fr); padding: 1rem; } .key { white-space: normal; } }
)";

constexpr const char* kEmptyNav = "<nav></nav>";

}  // namespace

std::string FindingText(const Finding& finding) {
  std::string text = fmt::format("    {}", VerdictText(finding.verdict));
  for (const ClaimFigure& figure : finding.figures) text += fmt::format("\n      {}: {}", figure.name, FigureText(figure));
  if (!finding.note.empty()) text += "\n      " + finding.note;
  return text + "\n";
}

ClaimsPage MakeClaimsPage(const ClaimSource& source, const std::vector<CheckedClaim>& checked) {
  ClaimsPage page{.name = source.name, .citation = source.citation, .title = source.title, .html = ""};
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>{0}: the source's claims</title><link rel=\"icon\" href=\"data:,\"><style>{1}</style></head>\n<body>\n"
      "<p class=\"where\">AreaLab · the source's claims</p><h1>{0}: {2}</h1>\n"
      "<p class=\"lede\">What the text says, in our words, beside what we find. Every figure was computed from the shader text when this page was made; a verdict follows from the figures by the rule that stands with it.</p>\n{3}\n",
      Escaped(source.citation), kClaimsStyle, Escaped(source.title), kEmptyNav);
  for (const auto& [claim, finding] : checked) {
    ++(finding.verdict == Verdict::kHolds    ? page.holds
       : finding.verdict == Verdict::kPartly ? page.partly
       : finding.verdict == Verdict::kFails  ? page.fails
                                             : page.unknown);
    const std::string plot = finding.plot.curves.empty() ? "" : PlotSvg(finding.plot);
    html += fmt::format("<article{}><div><span class=\"verdict v{}\">{}</span><span class=\"where\">{}</span><h2>{}</h2><dl>", plot.empty() ? " class=\"plain\"" : "",
                        static_cast<int>(finding.verdict), VerdictText(finding.verdict), Escaped(claim.where), Escaped(claim.sentence));
    for (const ClaimFigure& figure : finding.figures) html += fmt::format("<dt>{}</dt><dd>{}</dd>", Escaped(figure.name), Escaped(FigureText(figure)));
    html += fmt::format("</dl><p class=\"rule\">Holds where {}.</p>", Escaped(claim.holds));
    if (!finding.note.empty()) html += fmt::format("<p class=\"note\">{}</p>", Escaped(finding.note));
    html += fmt::format("<code>{}</code></div>{}</article>\n", Escaped(claim.command), plot);
  }
  page.html = html + "</body></html>\n";
  return page;
}

void LinkClaimsPages(std::vector<ClaimsPage>& pages, const std::string& report) {
  for (ClaimsPage& page : pages) {
    std::string nav = report.empty() ? "" : fmt::format("<a href=\"{}\">the report</a>", report);
    for (const ClaimsPage& other : pages) {
      nav += &other == &page ? fmt::format("<b>{}</b>", Escaped(other.citation))
                             : fmt::format("<a href=\"claims-{}.html\">{}</a>", other.name, Escaped(other.citation));
    }
    const std::size_t at = page.html.find(kEmptyNav);
    if (at != std::string::npos) page.html.replace(at, std::strlen(kEmptyNav), "<nav>" + nav + "</nav>");
  }
}

namespace {

// A line of the verdicts' counts, then the page.
std::optional<ClaimsPage> ReadClaimsPage(const ClaimSource& source, const std::optional<std::string>& entry) {
  if (!entry) return std::nullopt;
  std::istringstream in(*entry);
  ClaimsPage page{.name = source.name, .citation = source.citation, .title = source.title, .html = ""};
  if (!(in >> page.holds >> page.partly >> page.fails >> page.unknown) || in.get() != '\n') return std::nullopt;
  page.html = entry->substr(static_cast<std::size_t>(in.tellg()));
  return page;
}

}  // namespace

std::vector<ClaimsPage> CachedClaimsPages(const std::vector<ClaimSource>& sources, const std::string& platform,
                                          const std::filesystem::path& cache, const std::function<std::unique_ptr<ClaimBench>()>& bench) {
  ContentHash hash;
  hash.Program();
  hash.Text(platform);
  std::unique_ptr<ClaimBench> made;
  std::vector<ClaimsPage> pages;
  for (const ClaimSource& source : sources) {
    const std::string name = fmt::format("{}-{}.claims", hash.Name(), source.name);
    std::optional<ClaimsPage> page = ReadClaimsPage(source, ReadCacheEntry(cache, name));
    if (!page) {
      if (!made) made = bench();
      page = MakeClaimsPage(source, CheckClaims(source, *made));
      WriteCacheEntry(cache, name, fmt::format("{} {} {} {}\n{}", page->holds, page->partly, page->fails, page->unknown, page->html));
    }
    pages.push_back(std::move(*page));
  }
  return pages;
}

std::vector<double> Steps(double first, double last, int count) {
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) steps.push_back(first + (last - first) * i / (count - 1));
  return steps;
}

double LargestKink(const std::vector<double>& y) {
  double kink = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    largest = std::max(largest, std::abs(y[i]));
    if (i > 0 && i + 1 < y.size()) kink = std::max(kink, std::abs(y[i - 1] - 2.0 * y[i] + y[i + 1]));
  }
  return largest > 0.0 ? kink / largest : 0.0;
}

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace arealab
