// The form factor of a sphere clipped at the horizon, by a table of its quotient to the unclipped form factor
// [Hill & Heitz 2016, "multiplier in the LUT"]: elevation across, size up.
// size: sin² of the sphere's angular radius, its form factor when faced, [0, 1]; elevation: cosine between its centre and
// the normal.
float ClippedSphere(float size, float elevation) {
  return size * SampleTable(table_sphere, TableCoordinates(0.5 * elevation + 0.5, size)).x;
}
