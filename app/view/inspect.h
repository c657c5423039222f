// Figures of pictures and of one pixel.
#pragma once

#include <cstddef>

#include "app/view/panels.h"
#include "glsl/pixels.h"
#include "scenes/scene.h"

namespace arealab {

// What is known of pixel i without any technique: the surface, the lights' form factor, the truth in double with its
// error. `values` stays empty.
Inspection InspectPixel(const Scene& scene, const SurfacePixels& pixels, std::size_t i, Lobe lobe);

// Of the total, over the finite pixels that it lights; 0 where there are none.
double MeanLuminance(const RadianceImage& image);
double LuminancePercentile(const RadianceImage& image, double share);

}  // namespace arealab
