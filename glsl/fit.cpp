#include "glsl/fit.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <mutex>

#include "glsl/fit_cell.h"
#include "scenes/error.h"

namespace arealab {
namespace {

using fit::Cell;
using fit::View;

// 89°: the rows beyond it are noise for sharp lobes and spoil their neighbours (findings § 1, point 4).
const double kLastCosine = std::cos(glm::radians(89.0));
constexpr double kPublishedLastAngle = 1.57;  // ltc_code's, just short of π/2
constexpr int kPublishedNodes = 32;           // as many per axis as the authors' samples

double LastCosine(FitKind kind) {
  return kind == FitKind::kPublished ? 0.0 : kLastCosine;
}

double NodeCosine(FitKind kind, int row, int size) {
  const double cosine = fit::ViewCosine(static_cast<double>(row) / (size - 1), LastCosine(kind));
  return kind == FitKind::kPublished ? std::max(cosine, std::cos(kPublishedLastAngle)) : cosine;
}

double NodeRoughness(int column, int size) {
  return static_cast<double>(column) / (size - 1);
}

// Undoes the mirror frame, where the kind has one.
glm::dvec4 ToLocal(FitKind kind, double cosine, const glm::dvec4& stored) {
  if (kind == FitKind::kPublished) return stored;
  const fit::Whitening mirror{-std::sqrt((1.0 - cosine) * (1.0 + cosine)), cosine, 1.0, 1.0};
  const fit::Terms m = mirror.ToLocal(fit::Terms(stored.x, stored.y, stored.z, stored.w));
  return {m[0], m[1], m[2], m[3]};
}

void Store(const View& view, const Cell& cell, std::size_t texel, LtcTables* tables) {
  const bool mirror = tables->kind != FitKind::kPublished;
  const fit::Whitening frame = mirror ? fit::Whitening{-view.sine, view.cosine, 1.0, 1.0} : fit::Whitening{};
  const fit::Terms m = frame.FromLocal(cell.m);
  tables->matrix[texel] = glm::vec4(glm::dvec4(m[0], m[1], m[2], m[3]));
  if (!mirror) {
    tables->terms[texel] = glm::vec4(glm::dvec4(cell.albedo, cell.schlick, 0.0, 0.0));
    return;
  }
  // k (1 − b) + w = albedo; the shader's bracket is LTC + (w/k) E, its factor k.
  const double k = (cell.albedo - cell.cosine) / (1.0 - cell.leak);
  tables->terms[texel] = glm::vec4(glm::dvec4(k, cell.schlick * k / cell.albedo, cell.cosine / k, cell.leak));
}

fit::PolygonFit Settings(FitKind kind) {
  fit::PolygonFit settings;
  settings.with_cosine = kind == FitKind::kCosine;
  return settings;
}

class Progress {
 public:
  Progress(const std::function<void(double)>& report, int total) : report_(report), total_(total) {}
  void Step() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (report_) report_(static_cast<double>(done_) / total_);
  }

 private:
  const std::function<void(double)>& report_;
  const int total_;
  int done_ = 0;
  std::mutex mutex_;
};

// All nodes of the given columns; the others stay 0.
LtcTables FitColumns(FitKind kind, const FitOptions& options, const std::vector<int>& columns,
                     const std::function<void(double)>& report) {
  const int size = options.size;
  LtcTables tables{kind, size, {}, {}};
  const auto count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  tables.matrix.resize(count);
  tables.terms.resize(count);
  Progress progress(report, static_cast<int>(columns.size()));
  const auto view_of = [&](int row, int column) {
    return fit::MakeView(NodeRoughness(column, size), NodeCosine(kind, row, size));
  };
  const auto texel = [&](int row, int column) { return static_cast<std::size_t>(row * size + column); };
  if (kind == FitKind::kPublished) {
    // Their starts: at normal incidence the next rougher column, from there on the row before.
    std::vector<fit::PublishedCell> first(static_cast<std::size_t>(size));
    fit::AverageFrameTerms start;
    for (int column = size - 1; column >= 0; --column) {
      auto& cell = first[static_cast<std::size_t>(column)];
      cell = fit::FitPublishedCell(view_of(0, column), kPublishedNodes, true, start);
      start = cell.terms;
    }
    tbb::parallel_for(std::size_t{0}, columns.size(), [&](std::size_t index) {
      const int column = columns[index];
      fit::PublishedCell cell = first[static_cast<std::size_t>(column)];
      for (int row = 0; row < size; ++row) {
        const View view = view_of(row, column);
        if (row > 0) cell = fit::FitPublishedCell(view, kPublishedNodes, false, cell.terms);
        Store(view, cell.cell, texel(row, column), &tables);
      }
      progress.Step();
    });
    return tables;
  }
  const fit::LossQuads quads = fit::MakeLossQuads(options.rectangles);
  tbb::parallel_for(std::size_t{0}, columns.size(), [&](std::size_t index) {
    const int column = columns[index];
    Cell cell;
    for (int row = 0; row < size; ++row) {
      const View view = view_of(row, column);
      cell = fit::FitPolygonCell(view, quads, Settings(kind), row == 0 ? nullptr : &cell);
      Store(view, cell, texel(row, column), &tables);
    }
    progress.Step();
  });
  return tables;
}

std::string Stem(FitKind kind) {
  switch (kind) {
    case FitKind::kPolygon:
      return "ltc_ggx_polygon";
    case FitKind::kCosine:
      return "ltc_ggx_cosine";
    case FitKind::kPublished:
      return "ltc_ggx_l3";
  }
  return {};
}

// Complete or not at all: into a temporary file beside it, then renamed.
void WriteExr(const std::filesystem::path& file, int size, int channels, const float* values) {
  std::filesystem::path part = file;
  part.replace_extension(".part.exr");
  OIIO::ImageSpec spec(size, size, channels, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime",
                 "");  // else the writer adds the time of day: the same numbers must give the same bytes
  const auto output = OIIO::ImageOutput::create(part.string());
  if (!output || !output->open(part.string(), spec) || !output->write_image(OIIO::TypeDesc::FLOAT, values) ||
      !output->close())
    throw InputError(fmt::format("{}: cannot be written; expected a folder that can", file.string()));
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error)
    throw InputError(fmt::format("{}: {}; expected a writable file", file.string(), error.message()));
}

std::vector<glm::vec4> ReadExr(const std::filesystem::path& file, int* size) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) throw InputError(fmt::format("{}: cannot be read; expected a float EXR", file.string()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.nchannels != 4 || spec.width != spec.height || spec.width < 2)
    throw InputError(fmt::format("{}: {} × {} with {} channels; expected a square of 4 channels",
                                 file.string(), spec.width, spec.height, spec.nchannels));
  *size = spec.width;
  std::vector<glm::vec4> texels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
  if (!input->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, texels.data()))
    throw InputError(fmt::format("{}: cannot be read; expected a float EXR", file.string()));
  return texels;
}

}  // namespace

std::vector<std::string> TableNames() {
  return {"ltc_ggx_cosine", "ltc_ggx_l3", "ltc_ggx_polygon", "sphere"};
}

LtcTables FitLtc(FitKind kind, const FitOptions& options, const std::function<void(double)>& progress) {
  std::vector<int> columns(static_cast<std::size_t>(options.size));
  for (int i = 0; i < options.size; ++i) columns[static_cast<std::size_t>(i)] = i;
  return FitColumns(kind, options, columns, progress);
}

LtcTables FitLtcColumns(FitKind kind, const FitOptions& options, const std::vector<int>& columns) {
  return FitColumns(kind, options, columns, {});
}

LtcLookup Look(const LtcTables& tables, double roughness, double n_dot_v) {
  const int last = tables.size - 1;
  const double x = std::clamp(roughness, 0.0, 1.0) * last;
  const double y = fit::ViewPosition(n_dot_v, LastCosine(tables.kind)) * last;
  const int column = std::min(static_cast<int>(x), last - 1), row = std::min(static_cast<int>(y), last - 1);
  const double fx = x - column, fy = y - row;
  const auto mix = [&](const std::vector<glm::vec4>& texels) {
    const auto at = [&](int j, int i) {
      return glm::dvec4(texels[static_cast<std::size_t>((row + j) * tables.size + column + i)]);
    };
    return (at(0, 0) * (1.0 - fx) + at(0, 1) * fx) * (1.0 - fy) +
           (at(1, 0) * (1.0 - fx) + at(1, 1) * fx) * fy;
  };
  return {ToLocal(tables.kind, std::clamp(n_dot_v, 0.0, 1.0), mix(tables.matrix)), mix(tables.terms)};
}

glm::dvec4 NodeMatrix(const LtcTables& tables, int row, int column) {
  return ToLocal(tables.kind, NodeCosine(tables.kind, row, tables.size),
                 tables.matrix[static_cast<std::size_t>(row * tables.size + column)]);
}

double ClippedSphere(double y, double l) {
  y = std::clamp(y, -1.0, 1.0);
  l = std::clamp(l, 0.0, 1.0);
  const double cos_sigma = std::sqrt(1.0 - l), sin_omega = std::sqrt((1.0 - y) * (1.0 + y));
  if (y >= 0.0 && sin_omega <= cos_sigma) return y * l;  // wholly above
  if (y < 0.0 && sin_omega <= cos_sigma) return 0.0;     // wholly below
  // γ = asin(cos σ / sin ω): the azimuth's half range where the horizon cuts.
  const double sin_gamma = cos_sigma / sin_omega;
  const double cos_gamma = std::sqrt(std::max(0.0, (1.0 - sin_gamma) * (1.0 + sin_gamma)));
  const double gamma = std::asin(std::min(sin_gamma, 1.0));
  const double g =
      -2.0 * sin_omega * cos_sigma * cos_gamma + glm::half_pi<double>() - gamma + sin_gamma * cos_gamma;
  const double sin_sigma = std::sqrt(l);
  const double h = y * (cos_gamma * std::sqrt(std::max(0.0, l - cos_gamma * cos_gamma)) +
                        l * std::asin(std::min(cos_gamma / sin_sigma, 1.0)));
  const double irradiance = y >= 0.0 ? glm::pi<double>() * y * l + g - h : g + h;
  return irradiance * glm::one_over_pi<double>();
}

std::vector<float> FitSphere(int size) {
  std::vector<float> table;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double y = 2.0 * column / (size - 1) - 1.0, l = static_cast<double>(row) / (size - 1);
      table.push_back(static_cast<float>(row == 0 ? std::max(y, 0.0) : ClippedSphere(y, l) / l));
    }
  }
  return table;
}

void FitTables(const std::filesystem::path& folder, const FitOptions& options,
               const std::function<void(double)>& progress) {
  if (options.size < 2) throw InputError(fmt::format("table size {}; expected at least 2", options.size));
  const std::vector<std::string> known = TableNames();
  std::vector<std::string> wanted = options.tables.empty() ? known : options.tables;
  for (const std::string& name : wanted)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("table \"{}\"; expected one of {}", name, fmt::join(known, ", ")));
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(
        fmt::format("{}: {}; expected a folder that can be written", folder.string(), error.message()));
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string& name = wanted[i];
    const auto part = [&](double done) {
      if (progress) progress((static_cast<double>(i) + done) / static_cast<double>(wanted.size()));
    };
    if (name == "sphere") {
      WriteExr(folder / "sphere.exr", options.size, 1, FitSphere(options.size).data());
      part(1.0);
      continue;
    }
    for (const FitKind kind : {FitKind::kPolygon, FitKind::kCosine, FitKind::kPublished}) {
      if (name != Stem(kind)) continue;
      const LtcTables tables = FitLtc(kind, options, part);
      WriteExr(folder / (name + ".exr"), options.size, 4, &tables.matrix[0].x);
      WriteExr(folder / (name + "_terms.exr"), options.size, 4, &tables.terms[0].x);
    }
  }
}

LtcTables ReadLtcTables(const std::filesystem::path& folder, FitKind kind) {
  LtcTables tables;
  tables.kind = kind;
  tables.matrix = ReadExr(folder / (Stem(kind) + ".exr"), &tables.size);
  int terms_size = 0;
  tables.terms = ReadExr(folder / (Stem(kind) + "_terms.exr"), &terms_size);
  if (terms_size != tables.size)
    throw InputError(fmt::format("{}: sizes {} and {}; expected the same", (folder / Stem(kind)).string(),
                                 tables.size, terms_size));
  return tables;
}

}  // namespace arealab
