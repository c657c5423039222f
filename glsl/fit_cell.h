// The fit of one node (roughness, view angle) of an LTC table. Internal to the fit; the public interface is
// glsl/fit.h.
#pragma once

#include <optional>
#include <vector>

#include "glsl/fit_lobe.h"
#include "glsl/fit_polygon.h"

namespace arealab::fit {

struct Cell {
  Terms m{1.0, 0.0, 0.0, 1.0};  // M⁻¹ in the local frame, middle element 1
  double albedo = 0.0;          // ∫ρ
  double schlick = 0.0;         // ∫ρ (1 − v·h)⁵
  double leak = 0.0;            // the lobe's share below the horizon, of two lobes that of their sum
  double cosine = 0.0;          // integral of the cosine lobe that stands beside the LTC
  // Of a fit of two lobes: the second's M⁻¹, its shares of their sum and of `schlick`, and what the fit's unknowns were.
  Terms second{1.0, 0.0, 0.0, 1.0};
  double share = 0.0, second_schlick = 0.0;
  Eigen::Matrix<double, 9, 1> fitted = Eigen::Matrix<double, 9, 1>::Zero();
};

// Whitening about the mirror direction, of a diffuse lobe about the normal: widths of the GGX lobe in the plane of incidence (2α) and across it
// (2α cos θ), widened as the lobe reaches over the horizon. It only conditions the fit; no result depends on
// its exact value.
Whitening LobeWhitening(const View& view);

// What the polygon loss compares on, drawn once and used by every cell (common random numbers keep neighbours
// alike).
struct LossQuads {
  std::vector<Quad> world;  // rectangles in the local frame
  std::vector<Quad> lobe;   // parallelograms for a lobe of unit width
};
LossQuads MakeLossQuads(int count);

// Density of the lobe `p` after a whitening with determinant `scale` at one whitened direction, 1/sr, and ∂/∂p where asked for
// [Heitz et al. 2016, eq. 1].
double LtcDensity(const Terms& p, const glm::dvec3& v, double scale, Terms* gradient);

struct PolygonFit {
  int nodes = 24;             // per axis of the quadrature, more at grazing views
  double lobe_share = 0.1;    // of the loss: the quads scaled to the lobe
  double leak_penalty = 2.0;  // × b²
  bool with_cosine = false;
  bool above_horizon = false;    // the shader clips at the surface's horizon too
  double cosine_penalty = 5e-3;  // × w²
  // Of two lobes: how fast they may change from cell to cell, and what the second's share s tends to where it is of no use. The
  // sharper ρ is, the less a second lobe gains, and the slower it may change.
  double step_penalty = 1e-4;    // × squared distance to each neighbour's unknowns × (1 + 0.02/α)
  double share_penalty = 1e-5;   // × (s − ¼)²
};

// Findings § 1, points 1 and 2: least squares on the density, then on the integrals over `quads`. `previous`
// is the fit of the same roughness at the next smaller angle; without it the cell is the isotropic one at
// normal incidence.
Cell FitPolygonCell(const View& view, const LossQuads& quads, const PolygonFit& settings,
                    const Cell* previous);

// The same with two lobes. They start at the first neighbour's and are held near those of all, the next rougher and the one of the next
// smaller angle, since the loss alone leaves them free: a sharp ρ is one lobe. Without a neighbour ρ is that of roughness 1 at normal
// incidence; where `isotropic` the lobes are.
Cell FitPairCell(const View& view, const LossQuads& quads, const PolygonFit& settings, bool isotropic, const std::vector<Cell>& neighbours);

// ∫ρ over each quad (in the local frame), by `nodes`² nodes per side of the plane of incidence: the closed
// form of a control lobe, and a mask over the nodes for what that misses. Exact for any control in the limit
// of many nodes.
std::vector<double> LobeIntegrals(const View& view, const std::vector<Quad>& quads, int nodes,
                                  const Cell& control);

// The first of the two stages alone.
Cell FitDensityCell(const View& view, int nodes, const Cell* previous);

// Heitz et al. 2016: three terms about the average direction, ∫|ρ − albedo·LTC|³ over all directions, from
// the given start. The chain of starts is that of the authors' program: the next rougher cell at normal
// incidence, else the previous angle.
struct AverageFrameTerms {
  double m11 = 1.0, m22 = 1.0, m13 = 0.0;
};
struct PublishedCell {
  Cell cell;
  AverageFrameTerms terms;
};
PublishedCell FitPublishedCell(const View& view, int nodes, bool isotropic, const AverageFrameTerms& start);

}  // namespace arealab::fit
