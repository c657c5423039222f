#include "compare/check_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "compare/image_files.h"
#include "compare/metrics.h"
#include "compare/page_parts.h"
#include "scenes/replace_file.h"
#include "compare/stress_page.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

constexpr double kGoldenRange = 0.02;  // four times the golden test's threshold
constexpr double kTruthRange = 0.5;

constexpr Rgb kNonfinite{255, 0, 255}, kUnlit{84, 88, 95};

bool Finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// sRGB [IEC 61966-2-1] of radiance × 2^exposure.
std::vector<Rgb> Shown(const std::vector<glm::vec3>& radiance, double exposure) {
  const double gain = std::exp2(exposure);
  std::vector<Rgb> pixels;
  for (const glm::vec3& v : radiance) {
    Rgb code = kNonfinite;
    for (int c = 0; c < 3 && Finite(v); ++c) {
      const double linear = std::clamp(static_cast<double>(v[c]) * gain, 0.0, 1.0);
      const double encoded =
          linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
      code[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
    }
    pixels.push_back(code);
  }
  return pixels;
}

struct Maps {
  std::vector<Rgb> difference, magnitude;
};

// As the report's maps: luminance relative to the reference's, and the largest channel's; linear up to
// `range`.
Maps MapsOf(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b, double range) {
  double sum = 0.0;
  int count = 0;
  for (const glm::vec3& v : b) {
    if (!Finite(v) || v == glm::vec3(0.0f)) continue;
    sum += Luminance(v);
    ++count;
  }
  const double floor = count == 0 ? 0.0 : 0.01 * sum / count;
  Maps maps;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!Finite(a[i]) || !Finite(b[i])) {
      maps.difference.push_back(kNonfinite);
      maps.magnitude.push_back(kNonfinite);
    } else if (a[i] == glm::vec3(0.0f) && b[i] == glm::vec3(0.0f)) {
      maps.difference.push_back(kUnlit);
      maps.magnitude.push_back(kUnlit);
    } else {
      const double base =
          std::max({Luminance(b[i]), floor, 1e-30});  // black reference: any difference is off the scale
      const glm::vec3 d = glm::abs(a[i] - b[i]);
      maps.difference.push_back(
          Color(kSigned, 0.5 + 0.5 * (Luminance(a[i]) - Luminance(b[i])) / base / range));
      maps.magnitude.push_back(
          Color(kMagnitude, static_cast<double>(std::max({d.x, d.y, d.z})) / base / range));
    }
  }
  return maps;
}

std::string Comparison(const CheckCase& row, const RadianceImage& reference, const std::string& name,
                       double range) {
  const RadianceImage& image = *row.image;
  if (reference.size() != image.size() || reference.width != image.width) {
    return fmt::format("<p>The {} has another size: {}×{}.</p>\n", name, reference.width, reference.height);
  }
  std::string html = fmt::format("<h3>Against the {}</h3>\n", name);
  const std::span<const glm::vec3> emission =
      row.emission ? std::span<const glm::vec3>(*row.emission) : std::span<const glm::vec3>();
  for (const std::string lobe : {"total", "diffuse", "specular"}) {
    const auto of = [&](const RadianceImage& from) {
      return lobe == "total" ? TotalRadiance(from) : lobe == "diffuse" ? from.diffuse : from.specular;
    };
    const std::vector<glm::vec3> a = of(image), b = of(reference);
    const Maps maps = MapsOf(a, b, range);
    const bool whole = lobe == "total";
    html += "<div class=\"row\">\n";
    html += FigureHtml(Shown(whole ? Picture(image, emission) : a, row.exposure), image.width, lobe + ": result");
    html += FigureHtml(Shown(whole ? Picture(reference, emission) : b, row.exposure), image.width,
                   fmt::format("{}: {}", lobe, name));
    html += FigureHtml(maps.difference, image.width,
                   fmt::format("signed difference, −{0:g} % … +{0:g} %", 100.0 * range));
    html += FigureHtml(maps.magnitude, image.width, fmt::format("magnitude, 0 … {:g} %", 100.0 * range));
    html += "</div>\n";
  }
  return html;
}

// The result alone, where there is nothing to hold it against.
bool NeedsTruth(const CheckCase& row) {
  if (!row.golden) return true;
  return std::any_of(row.failures.begin(), row.failures.end(), [](const CheckFailure& failure) {
    return failure.kind == CheckKind::kBand || failure.kind == CheckKind::kMissingBand;
  });
}

std::string Ramp(bool is_signed) {
  std::string stops;
  constexpr int kStops = 16;
  for (int i = 0; i <= kStops; ++i) {
    const Rgb c = is_signed ? Color(kSigned, i / double{kStops}) : Color(kMagnitude, i / double{kStops});
    stops += fmt::format("{}rgb({} {} {})", i == 0 ? "" : ", ", c[0], c[1], c[2]);
  }
  return fmt::format("<span class=\"ramp\" style=\"background: linear-gradient(90deg, {})\"></span>", stops);
}

constexpr const char* kCheckStyle = R"(
:root { color-scheme: light dark; }
body { margin: 2rem auto; width: min(100% - 2rem, 72rem); font: 15px/1.5 system-ui, "Segoe UI", Roboto, Arial, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; } h2 { margin: 2.4rem 0 .4rem; font-size: 1.2rem; } h3 { margin: 1rem 0 .3rem; font-size: 1rem; }
pre { padding: .6rem .8rem; background: #8882; border-radius: 4px; white-space: pre-wrap; }
.row { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(13rem, 45%), 1fr)); gap: .8rem; margin-bottom: .8rem; }
figure { margin: 0; } figcaption { font-size: .85rem; opacity: .8; }
img { width: 100%; height: auto; image-rendering: pixelated; display: block; }
.ramp { display: inline-block; width: 12rem; height: .8rem; margin: 0 .5rem; vertical-align: middle; }
section { border-top: 1px solid #8886; }
)";

}  // namespace

namespace {

// Pictures of a case that failed, by what they show.
std::vector<HardPicture> PicturesOf(const CheckCase& row) {
  if (row.family) return HardPictures(*row.family);
  std::vector<HardPicture> pictures;
  if (!row.image) return pictures;
  const std::span<const glm::vec3> emission =
      row.emission ? std::span<const glm::vec3>(*row.emission) : std::span<const glm::vec3>();
  const auto picture = [&](const RadianceImage& image) { return Shown(Picture(image, emission), row.exposure); };
  pictures.push_back({"result", "", picture(*row.image)});
  const bool truth = NeedsTruth(row);
  const auto& reference = truth ? row.truth : row.golden;
  if (!reference || reference->width != row.image->width || reference->size() != row.image->size()) return pictures;
  pictures.push_back({"reference", "", picture(*reference)});
  pictures.push_back({"difference", "",
                      MapsOf(TotalRadiance(*row.image), TotalRadiance(*reference), truth ? kTruthRange : kGoldenRange).difference});
  return pictures;
}

std::string PageOf(const CheckResult& result) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>AreaLab: tests that "
      "failed</title>\n<style>{}</style></head>\n<body>\n"
      "<h1>{} failed</h1>\n<p>Drawn by {}; the goldens by {}.</p>\n",
      kCheckStyle, result.failures() == 1 ? "One test" : fmt::format("{} tests", result.failures()),
      Escaped(result.renderer),
      Escaped(result.golden_renderer.empty() ? "nobody yet" : result.golden_renderer));
  html += fmt::format(
      "<p>Signed: too dark {} too bright. Magnitude: none {} much. Relative to the reference's luminance, at "
      "least to "
      "1 % of its mean. Grey is unlit, magenta not finite.</p>\n",
      Ramp(true), Ramp(false));
  for (const CheckCase& row : result.cases) {
    if (row.failures.empty()) continue;
    html += fmt::format("<section>\n<h2>{}</h2>\n<ul>\n", Escaped(row.Title()));
    for (const CheckFailure& failure : row.failures) {
      html += fmt::format("<li><b>{}</b>: {}</li>\n", Name(failure.kind), Escaped(failure.message));
    }
    html += "</ul>\n";
    if (!row.rerun.empty()) html += fmt::format("<pre>{}</pre>\n", Escaped(row.rerun));
    if (row.image && row.golden) html += Comparison(row, *row.golden, "golden", kGoldenRange);
    if (row.image && row.truth && NeedsTruth(row)) html += Comparison(row, *row.truth, "truth", kTruthRange);
    if (row.family) {
      html += "<div class=\"row\">\n";
      for (const HardPicture& picture : HardPictures(*row.family)) html += FigureHtml(picture.pixels, kPatch, picture.caption);
      html += "</div>\n";
    }
    html += "</section>\n";
  }
  return html + "</body>\n</html>\n";
}

std::string FileStem(const CheckCase& row) {
  std::string stem = row.scene + "-" + row.variant + (row.hard.empty() ? "" : "-" + row.hard);
  for (char& c : stem) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && std::string_view("+=.-").find(c) == std::string_view::npos) c = '_';
  }
  return stem;
}

// What XML 1.0 does not hold (control characters, which a driver's log may have) is left out.
std::string InXml(const std::string& text) {
  std::string clean;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') clean += c;
  }
  return Escaped(clean);
}

std::string JUnitOf(const CheckResult& result, const std::map<const CheckCase*, std::vector<std::string>>& files) {
  std::map<std::string, std::vector<const CheckCase*>> suites;
  for (const CheckCase& row : result.cases) suites[row.scene].push_back(&row);
  const auto failed = [](const std::vector<const CheckCase*>& rows) {
    return std::ranges::count_if(rows, [](const CheckCase* row) { return !row->failures.empty(); });
  };
  std::string cases;
  std::ptrdiff_t failures = 0;
  for (const auto& [name, rows] : suites) {
    failures += failed(rows);
    cases += fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\">\n", InXml(name), rows.size(), failed(rows));
    for (const CheckCase* row : rows) {
      cases += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", InXml(row->hard.empty() ? name : name + "." + row->variant),
                           InXml(row->hard.empty() ? row->variant : row->hard));
      if (row->failures.empty()) {
        cases += "/>\n";
        continue;
      }
      std::string text;
      for (const CheckFailure& failure : row->failures) text += fmt::format("{}: {}\n", Name(failure.kind), failure.message);
      if (!row->rerun.empty()) text += row->rerun + "\n";
      for (const std::string& file : files.at(row)) text += fmt::format("[[ATTACHMENT|{}]]\n", file);
      cases += fmt::format(">\n      <failure type=\"{}\" message=\"{}\">{}</failure>\n    </testcase>\n", Name(row->failures[0].kind),
                           InXml(row->failures[0].message), InXml(text));
    }
    cases += "  </testsuite>\n";
  }
  return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"arealab check\" tests=\"{}\" failures=\"{}\">\n{}</testsuites>\n",
                     result.cases.size(), failures, cases);
}

}  // namespace

void WriteCheckReport(const CheckResult& result, const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder / "pictures", ignored);
  std::map<const CheckCase*, std::vector<std::string>> files;
  for (const CheckCase& row : result.cases) {
    if (row.failures.empty()) continue;
    std::vector<std::string>& of_case = files[&row];
    const int width = row.family ? kPatch : row.image ? row.image->width : 0;
    for (const HardPicture& picture : PicturesOf(row)) {
      const fs::path file = folder / "pictures" / fmt::format("{}-{}.png", FileStem(row), picture.name);
      ReplaceFile(file, PngBytes(picture.pixels, width));
      of_case.push_back(file.string());
    }
  }
  if (result.failures() > 0) {
    ReplaceFile(folder / "check.html", PageOf(result));
  } else {
    fs::remove(folder / "check.html", ignored);
  }
  ReplaceFile(folder / "junit.xml", JUnitOf(result, files));
}

}  // namespace arealab
