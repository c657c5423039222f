// Radiance as script files: a page opened from disk may neither fetch nor read back an image, but it may load scripts.
#pragma once

#include <span>
#include <string>

#include "compare/image_files.h"

namespace arealab {

// The arguments of the page's arealabImage(key, header, data): data is the base64 of a zlib stream of, for each stored
// plane of half bits (16-bit integers, all arithmetic modulo 65536), the low bytes and then the high bytes of
//   zigzag(v − (left + up − up-left)), v = the plane, or the plane minus its lobe's green;
// header = {width, height, exponent, planes: [how each plane comes: "raw", "-g" (minus green) or "=g" (equals it, not
// stored)]}, green first within a lobe. `key` is any text; the result contains no '<' and no line end inside.
std::string EncodePageImage(const std::string& key, const HalfImage& image);

// JSON text that may stand inside a <script>: '<', '>', '&' and the line separators are escaped.
std::string ScriptSafe(std::string json);

}  // namespace arealab
