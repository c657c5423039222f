#include "glsl/fit.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <malloc.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <mutex>

#include "glsl/fit_cell.h"
#include "scenes/error.h"
#include "scenes/write_image.h"

namespace arealab {
namespace {

using fit::Cell;
using fit::View;

// 89°: the rows beyond it are noise for sharp lobes and spoil their neighbours (findings § 1, point 4).
const double kLastCosine = std::cos(glm::radians(89.0));
constexpr double kPublishedLastAngle = 1.57;  // ltc_code's, just short of π/2
constexpr int kPublishedNodes = 32;           // as many per axis as the authors' samples

std::size_t LobesOf(FitKind kind) {
  return kind == FitKind::kTwo ? 2 : 1;
}

double LastCosine(FitKind kind) {
  return kind == FitKind::kPublished ? 0.0 : kLastCosine;
}

double NodeCosine(FitKind kind, LtcAxis axis, int row, int size) {
  const double x = static_cast<double>(row) / (size - 1);
  if (axis == LtcAxis::kCos) return 1.0 - x;
  if (axis == LtcAxis::kTheta) return std::max(std::cos(glm::half_pi<double>() * x), 0.0);
  const double cosine = fit::ViewCosine(x, LastCosine(kind));
  return kind == FitKind::kPublished ? std::max(cosine, std::cos(kPublishedLastAngle)) : cosine;
}

double AxisPosition(FitKind kind, LtcAxis axis, double cosine) {
  if (axis == LtcAxis::kCos) return 1.0 - cosine;
  if (axis == LtcAxis::kTheta) return std::acos(cosine) / glm::half_pi<double>();
  return fit::ViewPosition(cosine, LastCosine(kind));
}

double NodeRoughness(int column, int size) {
  return static_cast<double>(column) / (size - 1);
}

// The mirror frame, in which stored terms are those of a whitening that scales nothing.
fit::Whitening FrameOf(LtcFrame frame, double cosine) {
  if (frame == LtcFrame::kNormal) return {};
  return {-std::sqrt((1.0 - cosine) * (1.0 + cosine)), cosine, 1.0, 1.0};
}

// The scale of the published fit over that at which the middle element is 1: M⁻¹'s last row, the lobe's mean
// direction there, is a unit vector.
double UndividedScale(const fit::Terms& m) {
  return 1.0 / std::hypot(m[1], m[3]);
}

// A texel, and the fifth term of the other table, as M⁻¹ in the local frame with the middle element 1.
glm::dvec4 ToLocal(const LtcStorage& storage, double cosine, const glm::dvec4& texel, double fifth) {
  fit::Terms stored(texel.x, texel.y, texel.z, texel.w);
  if (storage.norm == LtcNorm::kNone) stored /= fifth;
  if (storage.norm == LtcNorm::kLast) stored = fit::Terms(texel.x, texel.y, texel.z, 1.0) / texel.w;
  const fit::Terms m = FrameOf(storage.frame, cosine).ToLocal(stored);
  return {m[0], m[1], m[2], m[3]};
}

// The reverse.
glm::vec4 FromLocal(const LtcStorage& storage, double cosine, const fit::Terms& m) {
  fit::Terms stored = FrameOf(storage.frame, cosine).FromLocal(m);
  if (storage.norm == LtcNorm::kNone) stored *= UndividedScale(m);
  if (storage.norm == LtcNorm::kLast) stored = fit::Terms(stored[0], stored[1], stored[2], 1.0) / stored[3];
  return {glm::dvec4(stored[0], stored[1], stored[2], stored[3])};
}

void Store(const View& view, const Cell& cell, std::size_t texel, LtcTables* tables) {
  tables->matrix[texel] = FromLocal(tables->storage, view.cosine, cell.m);
  const double scale = UndividedScale(cell.m);
  if (tables->kind == FitKind::kPublished) {
    tables->terms[texel] = glm::vec4(glm::dvec4(cell.albedo, cell.schlick, 0.0, scale));
    return;
  }
  if (tables->kind == FitKind::kTwo) {
    // Each lobe's form factor is 1 − its share below the horizon where a light covers the sky.
    const auto kept = [](const fit::Terms& m) { return 0.5 * (1.0 + m[0] / std::hypot(m[0], m[1])); };
    tables->matrix[tables->terms.size() + texel] = FromLocal(tables->storage, view.cosine, cell.second);
    tables->terms[texel] = glm::vec4(glm::dvec4(cell.albedo * (1.0 - cell.share) / (1.0 - cell.leak), (cell.schlick - cell.second_schlick) / kept(cell.m),
                                                cell.share / (1.0 - cell.share), cell.second_schlick / kept(cell.second)));
    return;
  }
  // k (1 − b) + w = albedo; the shader's bracket is LTC + (w/k) E, its factor k.
  const double k = (cell.albedo - cell.cosine) / (1.0 - cell.leak);
  tables->terms[texel] = glm::vec4(glm::dvec4(k, cell.schlick * k / cell.albedo, cell.cosine / k, scale));
}

fit::PolygonFit Settings(FitKind kind) {
  fit::PolygonFit settings;
  settings.with_cosine = kind == FitKind::kCosine;
  settings.above_horizon = kind == FitKind::kHorizon;
  if (settings.above_horizon) settings.leak_penalty = 0.0;  // what leaks is clipped
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

// What one node's arrays leave free serves the next: glibc would hand it back and have it zeroed again, a tenth of the fit's time.
void KeepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

// All nodes of the given columns; the others stay 0.
LtcTables FitColumns(Brdf brdf, FitKind kind, const FitOptions& options, const std::vector<int>& columns,
                     const std::function<void(double)>& report) {
  KeepFreedMemory();
  const int size = options.size;
  LtcTables tables{brdf, kind, OwnStorage(brdf, kind), size, {}, {}};
  const auto count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  tables.matrix.resize(count * LobesOf(kind));
  tables.terms.resize(count);
  Progress progress(report, static_cast<int>(columns.size()));
  const auto view_of = [&](int row, int column) {
    return fit::MakeView(brdf, NodeRoughness(column, size), NodeCosine(kind, LtcAxis::kSqrt, row, size));
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
  if (kind == FitKind::kTwo) {
    // Each cell is held by the next rougher one and by that of the next smaller angle: all of a diagonal at once.
    const int last = size - 1, span = last - *std::ranges::min_element(columns);
    std::vector<Cell> cells(count);
    for (int diagonal = 0; diagonal <= last + span; ++diagonal) {
      tbb::parallel_for(std::max(0, diagonal - span), std::min(diagonal, last) + 1, [&](int row) {
        const int column = last - (diagonal - row);
        std::vector<Cell> neighbours;
        if (column < last) neighbours.push_back(cells[texel(row, column + 1)]);
        if (row > 0) neighbours.push_back(cells[texel(row - 1, column)]);
        const View view = view_of(row, column);
        const Cell& cell = cells[texel(row, column)] = fit::FitPairCell(view, quads, Settings(kind), row == 0, neighbours);
        Store(view, cell, texel(row, column), &tables);
      });
      if (report) report((diagonal + 1.0) / (last + span + 1));
    }
    return tables;
  }
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
      return "polygon";
    case FitKind::kCosine:
      return "cosine";
    case FitKind::kHorizon:
      return "horizon";
    case FitKind::kPublished:
      return "l3";
    case FitKind::kTwo:
      return "two";
  }
  return {};
}

std::string NameInFiles(Brdf brdf) { return std::string(Name(brdf)) + (IsDiffuse(brdf) ? "_diffuse" : ""); }

// The options that choose it: fit, lobes, horizon.
std::string FilePrefix(FitKind kind) {
  switch (kind) {
    case FitKind::kPolygon:
      return "polygon_one_lobe";
    case FitKind::kCosine:
      return "polygon_cosine_lobe";
    case FitKind::kHorizon:
      return "polygon_one_true";
    case FitKind::kPublished:
      return "l3_one_lobe";
    case FitKind::kTwo:
      return "polygon_two_lobe";
  }
  return {};
}

constexpr std::array kFrameNames{"mirror", "normal"};
constexpr std::array kNormNames{"middle", "none", "last"};
constexpr std::array kAxisNames{"sqrt", "cos", "theta"};
constexpr std::array kKinds{FitKind::kPolygon, FitKind::kCosine, FitKind::kHorizon, FitKind::kPublished, FitKind::kTwo};

void WriteExr(const std::filesystem::path& file, int width, int height, int channels, const float* values) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  WriteImageFile(file, spec, values);
}

// Of `squares` one above the other.
std::vector<glm::vec4> ReadExr(const std::filesystem::path& file, std::size_t squares, int* size) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) throw InputError(fmt::format("{}: cannot be read; expected a float EXR", file.string()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.nchannels != 4 || spec.width * static_cast<int>(squares) != spec.height || spec.width < 2)
    throw InputError(fmt::format("{}: {} × {} with {} channels; expected {} of 4 channels", file.string(), spec.width,
                                 spec.height, spec.nchannels, squares == 1 ? "a square" : "two squares"));
  *size = spec.width;
  std::vector<glm::vec4> texels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
  if (!input->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, texels.data()))
    throw InputError(fmt::format("{}: cannot be read; expected a float EXR", file.string()));
  return texels;
}

}  // namespace

std::string MatrixFile(Brdf brdf, FitKind kind, const LtcStorage& storage) {
  return fmt::format("ltc_{}_{}_{}_{}_{}.exr", NameInFiles(brdf), FilePrefix(kind),
                     kFrameNames[static_cast<std::size_t>(storage.frame)],
                     kNormNames[static_cast<std::size_t>(storage.norm)],
                     kAxisNames[static_cast<std::size_t>(storage.axis)]);
}

std::string TermsFile(Brdf brdf, FitKind kind, LtcAxis axis) {
  return fmt::format("ltc_{}_{}_{}_terms.exr", NameInFiles(brdf), FilePrefix(kind),
                     kAxisNames[static_cast<std::size_t>(axis)]);
}

LtcStorage OwnStorage(Brdf brdf, FitKind kind) {
  LtcStorage storage;
  if (kind == FitKind::kPublished || IsDiffuse(brdf)) storage.frame = LtcFrame::kNormal;
  return storage;
}

std::vector<LtcStorage> StoragesOf(Brdf brdf, FitKind kind) {
  std::vector<LtcStorage> storages{OwnStorage(brdf, kind)};
  const auto add = [&](const LtcStorage& storage) {
    if (std::find(storages.begin(), storages.end(), storage) == storages.end()) storages.push_back(storage);
  };
  if (IsDiffuse(brdf)) return storages;
  if (kind == FitKind::kPolygon || kind == FitKind::kPublished) {
    add({LtcFrame::kMirror, LtcNorm::kMiddle, LtcAxis::kSqrt});
    add({LtcFrame::kNormal, LtcNorm::kMiddle, LtcAxis::kSqrt});
  }
  if (brdf == Brdf::kGgx && kind == FitKind::kPublished) {  // the talk's own
    for (const LtcNorm norm : {LtcNorm::kMiddle, LtcNorm::kNone, LtcNorm::kLast})
      for (const LtcAxis axis : {LtcAxis::kSqrt, LtcAxis::kCos, LtcAxis::kTheta})
        add({LtcFrame::kNormal, norm, axis});
  }
  return storages;
}

LtcTables Restored(const LtcTables& tables, const LtcStorage& storage) {
  LtcTables restored{tables.brdf, tables.kind, storage, tables.size, tables.matrix, tables.terms};
  for (int row = 0; row < tables.size; ++row) {
    const double cosine = NodeCosine(tables.kind, storage.axis, row, tables.size);
    for (int column = 0; column < tables.size; ++column) {
      const auto texel = static_cast<std::size_t>(row * tables.size + column);
      const LtcLookup look = storage.axis == tables.storage.axis
                                 ? LtcLookup{NodeMatrix(tables, row, column), tables.terms[texel]}
                                 : Look(tables, NodeRoughness(column, tables.size), cosine);
      const fit::Terms m(look.m.x, look.m.y, look.m.z, look.m.w);
      restored.matrix[texel] = FromLocal(storage, cosine, m);
      restored.terms[texel] = glm::vec4(look.terms);
      restored.terms[texel].w = static_cast<float>(UndividedScale(m));
    }
  }
  return restored;
}

std::vector<FitKind> KindsOf(Brdf brdf) {
  if (brdf == Brdf::kGgx) return {std::begin(kKinds), std::end(kKinds)};
  return {FitKind::kPolygon, FitKind::kPublished};
}

std::string TableName(Brdf brdf, FitKind kind) {
  return fmt::format("ltc_{}_{}", NameInFiles(brdf), Stem(kind));
}

std::vector<std::string> TableNames() {
  std::vector<std::string> names;
  for (const Brdf brdf : kFittedBrdfs)
    for (const FitKind kind : KindsOf(brdf)) names.push_back(TableName(brdf, kind));
  names.emplace_back("sphere");
  return names;
}

LtcTables FitLtc(Brdf brdf, FitKind kind, const FitOptions& options,
                 const std::function<void(double)>& progress) {
  std::vector<int> columns(static_cast<std::size_t>(options.size));
  for (int i = 0; i < options.size; ++i) columns[static_cast<std::size_t>(i)] = i;
  return FitColumns(brdf, kind, options, columns, progress);
}

LtcTables FitLtcColumns(Brdf brdf, FitKind kind, const FitOptions& options, const std::vector<int>& columns) {
  return FitColumns(brdf, kind, options, columns, {});
}

LtcLookup Look(const LtcTables& tables, double roughness, double n_dot_v) {
  const int last = tables.size - 1;
  const double x = std::clamp(roughness, 0.0, 1.0) * last;
  const double cosine = std::clamp(n_dot_v, 0.0, 1.0);
  const double y = std::clamp(AxisPosition(tables.kind, tables.storage.axis, cosine), 0.0, 1.0) * last;
  const int column = std::min(static_cast<int>(x), last - 1), row = std::min(static_cast<int>(y), last - 1);
  const double fx = x - column, fy = y - row;
  const auto mix = [&](const std::vector<glm::vec4>& texels, std::size_t first = 0) {
    const auto at = [&](int j, int i) {
      return glm::dvec4(texels[first + static_cast<std::size_t>((row + j) * tables.size + column + i)]);
    };
    return (at(0, 0) * (1.0 - fx) + at(0, 1) * fx) * (1.0 - fy) +
           (at(1, 0) * (1.0 - fx) + at(1, 1) * fx) * fy;
  };
  const glm::dvec4 terms = mix(tables.terms);
  LtcLookup look{ToLocal(tables.storage, cosine, mix(tables.matrix), terms.w), terms};
  if (tables.kind == FitKind::kTwo) look.second = ToLocal(tables.storage, cosine, mix(tables.matrix, tables.terms.size()), terms.w);
  return look;
}

LtcLookup NodeLookup(const LtcTables& tables, int row, int column) {
  const auto texel = static_cast<std::size_t>(row * tables.size + column);
  const double cosine = NodeCosine(tables.kind, tables.storage.axis, row, tables.size);
  const glm::dvec4 terms = tables.terms[texel];
  LtcLookup look{ToLocal(tables.storage, cosine, tables.matrix[texel], terms.w), terms};
  if (tables.kind == FitKind::kTwo) look.second = ToLocal(tables.storage, cosine, tables.matrix[tables.terms.size() + texel], terms.w);
  return look;
}

glm::dvec4 NodeMatrix(const LtcTables& tables, int row, int column) {
  return NodeLookup(tables, row, column).m;
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

namespace {

// Lobes in all their storages.
void WriteLtc(const std::filesystem::path& folder, const LtcTables& own) {
  for (const LtcStorage& storage : StoragesOf(own.brdf, own.kind)) {
    const LtcTables tables = storage == own.storage ? own : Restored(own, storage);
    WriteExr(folder / MatrixFile(own.brdf, own.kind, storage), own.size, own.size * static_cast<int>(LobesOf(own.kind)), 4, &tables.matrix[0].x);
    const bool first_of_axis = storage.axis != LtcAxis::kSqrt || storage == own.storage;
    if (first_of_axis && storage.norm == LtcNorm::kMiddle)
      WriteExr(folder / TermsFile(own.brdf, own.kind, storage.axis), own.size, own.size, 4, &tables.terms[0].x);
  }
}

}  // namespace

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
      WriteExr(folder / "sphere.exr", options.size, options.size, 1, FitSphere(options.size).data());
      part(1.0);
      continue;
    }
    for (const Brdf brdf : kFittedBrdfs)
      for (const FitKind kind : KindsOf(brdf))
        if (name == TableName(brdf, kind)) WriteLtc(folder, FitLtc(brdf, kind, options, part));
  }
}

LtcTables ReadLtcTables(const std::filesystem::path& folder, Brdf brdf, FitKind kind,
                        const LtcStorage& storage) {
  LtcTables tables;
  tables.brdf = brdf;
  tables.kind = kind;
  tables.storage = storage;
  const std::filesystem::path matrix = folder / MatrixFile(brdf, kind, storage);
  tables.matrix = ReadExr(matrix, LobesOf(kind), &tables.size);
  int terms_size = 0;
  tables.terms = ReadExr(folder / TermsFile(brdf, kind, storage.axis), 1, &terms_size);
  if (terms_size != tables.size)
    throw InputError(
        fmt::format("{}: sizes {} and {}; expected the same", matrix.string(), tables.size, terms_size));
  return tables;
}

LtcTables ReadLtcTables(const std::filesystem::path& folder, Brdf brdf, FitKind kind) {
  return ReadLtcTables(folder, brdf, kind, OwnStorage(brdf, kind));
}

}  // namespace arealab
