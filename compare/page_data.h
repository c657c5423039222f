// Radiance as script files: a page opened from disk may neither fetch nor read back an image, but it may load
// scripts.
#pragma once

#include <span>
#include <string>

#include "compare/image_files.h"

namespace arealab {

// A call of the page's arealabImage(key, header, data). `data` is a zlib stream, one character per byte in
// windows-1252, the encoding that the file is to be read in. It holds, for each stored plane of half bits
// without their lowest `shift` bits, which are 0 in all planes (16-bit integers, all arithmetic modulo 65536),
// the low bytes and then the high bytes of zigzag(v − (left +
// up − up-left)), where v is by the header
//   planes[i] = "raw": the plane; "-g": the plane minus its lobe's green; "-t": minus the same plane of
//   `truth`;
//   "=g", "=t": equal to it, and not stored.
// Green comes first within a lobe. header = {width, height, exponent, shift, planes}; `truth` counts without its lowest `shift` bits too. `key` is any text. `truth` may
// be null; it serves only where its size and exponent are the image's.
std::string EncodePageImage(const std::string& key, const HalfImage& image, const HalfImage* truth = nullptr);

// JSON text that may stand inside a <script>: '<', '>', '&' and the line separators are escaped.
std::string ScriptSafe(std::string json);

}  // namespace arealab
