// The talk on ambient apertures [Oat 2006], its claims as numbers: how far its smoothstep is from the exact intersection of two caps, as
// in its "Quality Comparison", what its printed formula gives, and how bright its averaged centroid is.
#pragma once

#include <vector>

namespace arealab {

// The area that two caps share, sr; radii and the distance of their centres in radians.
double CapOverlapExact(double radius0, double radius1, double distance);
double CapOverlapSmoothstep(double radius0, double radius1, double distance);
// The closed form of "Spherical cap intersection" where rims cross, as printed and with its third term's sign corrected.
double CapOverlapPrinted(double radius0, double radius1, double distance);
double CapOverlapCorrected(double radius0, double radius1, double distance);

// One pair of radii along the distance from containment to parting: a curve of the comparison.
struct CapCurve {
  double radius0 = 0.0, radius1 = 0.0;
  std::vector<double> distance, exact, smoothstep;
};
CapCurve MakeCapCurve(double radius0, double radius1, int count);

// Smoothstep less exact, over the smaller cap's area, on an even grid of radii in (0, π/2] and of distances between containment and
// parting, `steps` of each.
struct CapOverlapError {
  double rms = 0.0, bias = 0.0;
  double largest = 0.0;  // signed
  double radius0 = 0.0, radius1 = 0.0, distance = 0.0;  // where it is largest
};
CapOverlapError MeasureCapOverlap(int steps = 48);

// Lambert's cosine halfway between the light and an open hemisphere's axis, over the true one: a small light at `angle` from the normal.
double AveragedCentroidGain(double angle);

}  // namespace arealab
