# The picture of screen.toml's light: a red disk, bars, a gradient on a dark ground; plain PPM, sRGB.
BEGIN {
  print "P3 48 32 255"
  for (y = 0; y < 32; y++) for (x = 0; x < 48; x++) {
    r = g = b = 12
    if (x < 16 && (x - 7.5) ^ 2 + (y - 15.5) ^ 2 < 42) { r = 255; g = 60; b = 20 }
    if (x >= 16 && x < 32 && y >= 4 && y < 28 && int((x - 16) / 2) % 2 == 1) r = g = b = 235
    if (x >= 32 && x < 44 && y >= 4 && y < 28) { r = 10; g = int(255 * (27 - y) / 23); b = int(255 * (y - 4) / 23) }
    printf "%d %d %d%s", r, g, b, x < 47 ? "  " : "\n"
  }
}
