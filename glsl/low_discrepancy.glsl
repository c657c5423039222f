#pragma once
// Points of the first two Sobol dimensions, Owen-scrambled by hashing [Burley 2020]. Dual: also compiles as C++.
// The first 2^k points are a stratified net, and each point alone is uniform: every estimate from them is unbiased over seeds.
#include "surface.glsl"

// A mixing of 32 bits without bias to speak of: Wellons's lowbias32.
uint Hash(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

// For every x one to one in the seed.
uint HashCombine(uint seed, uint x) { return Hash(seed ^ Hash(x + 0x9e3779b9u)); }

uint ReverseBits(uint x) {
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  return (x << 16) | (x >> 16);
}

// Each bit is flipped by a hash of the seed and of the bits above it, a scrambling by nested uniform permutations
// [Burley 2020, §3.3; the hash is Vegdahl 2021's, which has less bias than the paper's].
uint OwenScramble(uint x, uint seed) {
  x = ReverseBits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return ReverseBits(x);
}

// The second dimension's generator matrix, of the primitive polynomial x + 1: direction number i+1 is i's xor its half.
uint SobolSecond(uint index) {
  uint value = 0u;
  uint direction = 0x80000000u;
  for (uint rest = index; rest != 0u; rest = rest >> 1) {
    if ((rest & 1u) != 0u) value ^= direction;
    direction ^= direction >> 1;
  }
  return value;
}

// 24 bits of it as a number in (0, 1), never an end.
float UnitInterval(uint x) { return (float(x >> 8) + 0.5) * (1.0 / 16777216.0); }

// Point `index` of the sequence that `seed` scrambles.
vec2 SobolPoint(uint index, uint seed) {
  return vec2(UnitInterval(OwenScramble(ReverseBits(index), HashCombine(seed, 1u))),
              UnitInterval(OwenScramble(SobolSecond(index), HashCombine(seed, 2u))));
}
