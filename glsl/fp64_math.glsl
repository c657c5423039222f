#pragma once
// The built-in functions that GLSL has for float only (GLSL 4.50, § 8.1 and 8.2), for double: glsl/fp64_rewrite.h turns
// acos(x) into fp64_acos(x). Errors, against exact values in their normal range: tests/glsl/fp64_math_test.cpp states them.
// The series are Taylor's; their lengths follow from the reduced range stated beside each. A sum of two doubles
// ("pair": x the leading part, y the rest) carries what a double cannot hold, without fma, which drivers may unfuse.
// This file is not rewritten; it also compiles as C++ with `precise`, `lf` and packDouble2x32 supplied.

const dvec2 kFp64HalfPi = dvec2(1.5707963267948966lf, 6.123233995736766e-17lf);
const dvec2 kFp64Pi = dvec2(3.141592653589793lf, 1.2246467991473532e-16lf);
const dvec2 kFp64InverseLn2 = dvec2(1.4426950408889634lf, 2.0355273740931033e-17lf);
const dvec2 kFp64Ln2 = dvec2(0.6931471805599453lf, 2.3190468138462996e-17lf);
// ln 2 again, its first 32 bits and the rest: an exponent times the first is exact.
const double kFp64Ln2High = 0.6931471803691238lf;
const double kFp64Ln2Low = 1.9082149292705877e-10lf;

// 2^k, for k in [-1022, 1023].
double Fp64PowerOfTwo(int k) { return packDouble2x32(uvec2(0u, uint(k + 1023) << 20)); }

double Fp64Infinity() { return packDouble2x32(uvec2(0u, 0x7ff00000u)); }
double Fp64NotANumber() { return packDouble2x32(uvec2(0u, 0x7ff80000u)); }

// x · 2^k in two steps, for k in [-2044, 2046].
double Fp64Scale(double x, int k) {
  int half_k = k / 2;
  return x * Fp64PowerOfTwo(half_k) * Fp64PowerOfTwo(k - half_k);
}

// a + b as a pair, exactly [Knuth 1969].
dvec2 Fp64TwoSum(double a, double b) {
  precise double sum = a + b;
  precise double b_seen = sum - a;
  precise double a_seen = sum - b_seen;
  precise double rest = (a - a_seen) + (b - b_seen);
  return dvec2(sum, rest);
}

// The upper 26 bits of a [Veltkamp 1968]; |a| < 2^996.
double Fp64UpperHalf(double a) {
  precise double scaled = 134217729.0lf * a;  // 2^27 + 1
  precise double shifted = scaled - a;
  precise double upper = scaled - shifted;
  return upper;
}

// a · b as a pair, exactly [Dekker 1971].
dvec2 Fp64TwoProduct(double a, double b) {
  precise double product = a * b;
  precise double a_upper = Fp64UpperHalf(a);
  precise double a_lower = a - a_upper;
  precise double b_upper = Fp64UpperHalf(b);
  precise double b_lower = b - b_upper;
  precise double cross_terms = a_upper * b_lower + a_lower * b_upper;
  precise double rest = ((a_upper * b_upper - product) + cross_terms) + a_lower * b_lower;
  return dvec2(product, rest);
}

// Sum and product of pairs, to about 2^-100.
dvec2 Fp64Add(dvec2 a, dvec2 b) {
  dvec2 sum = Fp64TwoSum(a.x, b.x);
  precise double rest = sum.y + (a.y + b.y);
  return Fp64TwoSum(sum.x, rest);
}

dvec2 Fp64Multiply(dvec2 a, dvec2 b) {
  dvec2 product = Fp64TwoProduct(a.x, b.x);
  precise double rest = product.y + (a.x * b.y + a.y * b.x);
  return Fp64TwoSum(product.x, rest);
}

// exp(r.x + r.y) for |r.x| <= ln(2)/2: the next term, x^14/14!, is 4e-18 there.
double Fp64ExpReduced(dvec2 r) {
  double x = r.x;
  double series =
      1.0lf / 2.0lf +
      x * (1.0lf / 6.0lf +
           x * (1.0lf / 24.0lf +
                x * (1.0lf / 120.0lf +
                     x * (1.0lf / 720.0lf +
                          x * (1.0lf / 5040.0lf +
                               x * (1.0lf / 40320.0lf +
                                    x * (1.0lf / 362880.0lf +
                                         x * (1.0lf / 3628800.0lf +
                                              x * (1.0lf / 39916800.0lf +
                                                   x * (1.0lf / 479001600.0lf + x * (1.0lf / 6227020800.0lf)))))))))));
  precise double small = r.y * (1.0lf + x) + x * x * series;
  precise double result = 1.0lf + (x + small);
  return result;
}

// exp of a pair.
double Fp64ExpPair(dvec2 x) {
  if (isnan(x.x)) return x.x;
  if (x.x > 709.79lf) return Fp64Infinity();  // ln of the greatest double is 709.78
  if (x.x < -745.2lf) return 0.0lf;           // ln of half the least subnormal is -745.13
  double k = floor(x.x * kFp64InverseLn2.x + 0.5lf);
  precise double high = x.x - k * kFp64Ln2High;
  precise double low = x.y - k * kFp64Ln2Low;
  return Fp64Scale(Fp64ExpReduced(Fp64TwoSum(high, low)), int(k));
}

// ln of the mantissa of x as a pair, and the exponent: x = 2^exponent · mantissa, mantissa in [√½, √2]; x normal, positive.
dvec2 Fp64LogMantissa(double x, OUT(double) exponent) {
  uvec2 bits = unpackDouble2x32(x);
  int k = int(bits.y >> 20) - 1023;
  double mantissa = packDouble2x32(uvec2(bits.x, (bits.y & 0x000fffffu) | 0x3ff00000u));
  if (mantissa > 1.4142135623730951lf) {
    mantissa *= 0.5lf;
    k += 1;
  }
  exponent = double(k);
  // ln m = 2 artanh s, s = (m - 1)/(m + 1), |s| <= 0.172, s² <= 0.0295: the next term, s^24/25, is 7e-20 of the whole.
  precise double numerator = mantissa - 1.0lf;  // exact
  dvec2 denominator = Fp64TwoSum(mantissa, 1.0lf);
  precise double s = numerator / denominator.x;
  dvec2 seen = Fp64TwoProduct(s, denominator.x);
  precise double s_rest = (((numerator - seen.x) - seen.y) - s * denominator.y) / denominator.x;
  dvec2 s_pair = dvec2(s, s_rest);
  dvec2 z = Fp64Multiply(s_pair, s_pair);
  double tail =
      z.x *
      (2.0lf / 5.0lf +
       z.x * (2.0lf / 7.0lf +
              z.x * (2.0lf / 9.0lf +
                     z.x * (2.0lf / 11.0lf +
                            z.x * (2.0lf / 13.0lf +
                                   z.x * (2.0lf / 15.0lf +
                                          z.x * (2.0lf / 17.0lf +
                                                 z.x * (2.0lf / 19.0lf +
                                                        z.x * (2.0lf / 21.0lf + z.x * (2.0lf / 23.0lf))))))))));
  dvec2 cubic = Fp64Add(dvec2(0.6666666666666666lf, 3.700743415417188e-17lf), dvec2(tail, 0.0lf));  // 2/3 + tail
  return Fp64Multiply(s_pair, Fp64Add(dvec2(2.0lf, 0.0lf), Fp64Multiply(z, cubic)));
}

// Whether ln x is no finite number; if so, `value` is what it is instead.
bool Fp64LogIsSpecial(double x, OUT(double) value) {
  value = x;
  if (isnan(x) || x == Fp64Infinity()) return true;
  value = x == 0.0lf ? -Fp64Infinity() : Fp64NotANumber();
  return x <= 0.0lf;
}

// Brings a subnormal into the normal range; `exponent` is what has to be added to the logarithm to base 2.
double Fp64Normal(double x, OUT(double) exponent) {
  bool subnormal = x < 2.2250738585072014e-308lf;  // 2^-1022
  exponent = subnormal ? -54.0lf : 0.0lf;
  return subnormal ? x * 18014398509481984.0lf : x;  // 2^54
}

// ln x as a pair, for finite x > 0.
dvec2 Fp64LogPair(double x) {
  double shift;
  double normal = Fp64Normal(x, shift);
  double exponent;
  dvec2 mantissa = Fp64LogMantissa(normal, exponent);
  exponent += shift;
  dvec2 high = Fp64TwoSum(exponent * kFp64Ln2High, mantissa.x);
  precise double low = high.y + (mantissa.y + exponent * kFp64Ln2Low);
  return Fp64TwoSum(high.x, low);
}

double fp64_exp(double x) { return Fp64ExpPair(dvec2(x, 0.0lf)); }

double fp64_exp2(double x) {
  if (isnan(x)) return x;
  if (x >= 1024.0lf) return Fp64Infinity();
  if (x < -1076.0lf) return 0.0lf;  // half the least subnormal is 2^-1075
  double k = floor(x + 0.5lf);
  return Fp64Scale(Fp64ExpReduced(Fp64Multiply(dvec2(x - k, 0.0lf), kFp64Ln2)), int(k));
}

double fp64_log(double x) {
  double special;
  if (Fp64LogIsSpecial(x, special)) return special;
  return Fp64LogPair(x).x;
}

double fp64_log2(double x) {
  double special;
  if (Fp64LogIsSpecial(x, special)) return special;
  double shift;
  double normal = Fp64Normal(x, shift);
  double exponent;
  dvec2 mantissa = Fp64LogMantissa(normal, exponent);
  return Fp64Add(dvec2(exponent + shift, 0.0lf), Fp64Multiply(mantissa, kFp64InverseLn2)).x;
}

// Not a number where x < 0, as GLSL leaves it undefined.
double fp64_pow(double x, double y) {
  if (y == 0.0lf || x == 1.0lf) return 1.0lf;
  if (x == 0.0lf) return y > 0.0lf ? 0.0lf : Fp64Infinity();
  double special;
  if (Fp64LogIsSpecial(x, special)) return x > 0.0lf && y < 0.0lf ? 0.0lf : special;
  return Fp64ExpPair(Fp64Multiply(dvec2(y, 0.0lf), Fp64LogPair(x)));
}

// sinh for |x| <= 1: the next term, x^20/21!, is 2e-20.
double Fp64SinhSeries(double x) {
  double z = x * x;
  double series =
      z *
      (1.0lf / 6.0lf +
       z * (1.0lf / 120.0lf +
            z * (1.0lf / 5040.0lf +
                 z * (1.0lf / 362880.0lf +
                      z * (1.0lf / 39916800.0lf +
                           z * (1.0lf / 6227020800.0lf +
                                z * (1.0lf / 1307674368000.0lf +
                                     z * (1.0lf / 355687428096000.0lf + z * (1.0lf / 121645100408832000.0lf)))))))));
  return x + x * series;
}

double fp64_cosh(double x) {
  double half_exp = fp64_exp(0.5lf * abs(x));
  // exp(|x|)/2 by its root, which does not overflow first; above 40 exp(-|x|) no longer counts.
  double grown = 0.5lf * half_exp * half_exp;
  if (abs(x) > 40.0lf) return grown;
  double exponential = fp64_exp(abs(x));
  return 0.5lf * exponential + 0.5lf / exponential;
}

double fp64_sinh(double x) {
  if (abs(x) <= 1.0lf) return Fp64SinhSeries(x);
  double size = abs(x);
  double half_exp = fp64_exp(0.5lf * size);
  double exponential = fp64_exp(size);
  double result = size > 40.0lf ? 0.5lf * half_exp * half_exp : 0.5lf * exponential - 0.5lf / exponential;
  return x < 0.0lf ? -result : result;
}

double fp64_tanh(double x) {
  if (abs(x) <= 0.5lf) return Fp64SinhSeries(x) / fp64_cosh(x);
  double result = 1.0lf - 2.0lf / (fp64_exp(2.0lf * abs(x)) + 1.0lf);
  return x < 0.0lf ? -result : result;
}

// x = quadrant · π/2 + the returned pair, which is in [-π/4, π/4]; |x| <= 1e6. π/2 stands in parts of 33, 33 and 53
// bits: multiples of the first two are exact [Cody & Waite 1980].
dvec2 Fp64ReduceAngle(double x, OUT(int) quadrant) {
  double k = floor(x * 0.6366197723675814lf + 0.5lf);  // 2/π
  quadrant = int(k - 4.0lf * floor(0.25lf * k));
  precise double near = x - k * 1.5707963267341256lf;
  dvec2 r = Fp64TwoSum(near, -k * 6.077100506303966e-11lf);
  precise double low = r.y - k * 2.0222662487959506e-21lf;
  return Fp64TwoSum(r.x, low);
}

// sin and cos of a pair in [-π/4, π/4]: the next terms are x^19/19! = 8e-20 and x^18/18! = 2e-18.
double Fp64SinReduced(dvec2 r) {
  double z = r.x * r.x;
  double series =
      z *
      (-1.0lf / 6.0lf +
       z * (1.0lf / 120.0lf +
            z * (-1.0lf / 5040.0lf +
                 z * (1.0lf / 362880.0lf +
                      z * (-1.0lf / 39916800.0lf +
                           z * (1.0lf / 6227020800.0lf +
                                z * (-1.0lf / 1307674368000.0lf + z * (1.0lf / 355687428096000.0lf))))))));
  precise double small = r.x * series + r.y * (1.0lf - 0.5lf * z);
  precise double result = r.x + small;
  return result;
}

double Fp64CosReduced(dvec2 r) {
  double z = r.x * r.x;
  double series =
      z *
      (1.0lf / 24.0lf +
       z * (-1.0lf / 720.0lf +
            z * (1.0lf / 40320.0lf +
                 z * (-1.0lf / 3628800.0lf +
                      z * (1.0lf / 479001600.0lf +
                           z * (-1.0lf / 87178291200.0lf + z * (1.0lf / 20922789888000.0lf)))))));
  precise double half_z = 0.5lf * z;
  precise double head = 1.0lf - half_z;
  precise double head_rest = (1.0lf - head) - half_z;
  precise double result = head + (head_rest + (z * series - r.x * r.y));
  return result;
}

double Fp64SinOfQuadrant(dvec2 r, int quadrant) {
  double size = quadrant == 1 || quadrant == 3 ? Fp64CosReduced(r) : Fp64SinReduced(r);
  return quadrant >= 2 ? -size : size;
}

double fp64_sin(double x) {
  int quadrant;
  dvec2 r = Fp64ReduceAngle(x, quadrant);
  return Fp64SinOfQuadrant(r, quadrant);
}

double fp64_cos(double x) {
  int quadrant;
  dvec2 r = Fp64ReduceAngle(x, quadrant);
  return Fp64SinOfQuadrant(r, quadrant == 3 ? 0 : quadrant + 1);
}

double fp64_tan(double x) {
  int quadrant;
  dvec2 r = Fp64ReduceAngle(x, quadrant);
  double sine = Fp64SinReduced(r);
  double cosine = Fp64CosReduced(r);
  return quadrant == 1 || quadrant == 3 ? -cosine / sine : sine / cosine;
}

// arctan(a/b) in [0, π/2], for a, b >= 0; 0 where both are 0. With t = min(a, b)/max(a, b) and a node c near t,
// arctan t = arctan c + arctan u, u = (t - c)/(1 + t c); c = 0, 3/8 or 7/8 leaves |u| <= 0.184, u² <= 0.0338: the next
// term, u^24/25, is 2e-19.
double Fp64AtanRatio(double a, double b) {
  bool steep = a > b;
  if (a == 0.0lf && b == 0.0lf) return 0.0lf;
  double t = steep ? b / a : a / b;
  double node = 0.0lf;
  dvec2 base = steep ? kFp64HalfPi : dvec2(0.0lf, 0.0lf);
  if (t > 0.6lf) {
    node = 0.875lf;
    base = steep ? dvec2(0.8519663271732721lf, -2.831157406069101e-17lf)    // arctan(8/7)
                 : dvec2(0.7188299996216245lf, -2.1478388444456983e-17lf);  // arctan(7/8)
  } else if (t > 0.18lf) {
    node = 0.375lf;
    base = steep ? dvec2(1.2120256565243244lf, 3.034500430874847e-17lf)      // arctan(8/3)
                 : dvec2(0.35877067027057225lf, -2.4623815582638635e-17lf);  // arctan(3/8)
  }
  double u = (t - node) / (1.0lf + t * node);
  double z = u * u;
  double series =
      z *
      (-1.0lf / 3.0lf +
       z * (1.0lf / 5.0lf +
            z * (-1.0lf / 7.0lf +
                 z * (1.0lf / 9.0lf +
                      z * (-1.0lf / 11.0lf +
                           z * (1.0lf / 13.0lf +
                                z * (-1.0lf / 15.0lf +
                                     z * (1.0lf / 17.0lf +
                                          z * (-1.0lf / 19.0lf + z * (1.0lf / 21.0lf + z * (-1.0lf / 23.0lf)))))))))));
  double arc = u + u * series;
  precise double result = base.x + ((steep ? -arc : arc) + base.y);
  return result;
}

double fp64_atan(double x) {
  double size = Fp64AtanRatio(abs(x), 1.0lf);
  return x < 0.0lf ? -size : size;
}

double fp64_atan(double y, double x) {
  double size = Fp64AtanRatio(abs(y), abs(x));
  precise double supplement = (kFp64Pi.x - size) + kFp64Pi.y;
  double result = x < 0.0lf ? supplement : size;
  return y < 0.0lf ? -result : result;
}

double fp64_asin(double x) {
  double size = Fp64AtanRatio(abs(x), sqrt((1.0lf - abs(x)) * (1.0lf + abs(x))));
  return x < 0.0lf ? -size : size;
}

double fp64_acos(double x) { return 2.0lf * Fp64AtanRatio(sqrt(1.0lf - x), sqrt(1.0lf + x)); }

double fp64_radians(double x) { return x * 0.017453292519943295lf; }  // π/180
double fp64_degrees(double x) { return x * 57.29577951308232lf; }     // 180/π

// The same, component by component.
#define FP64_COMPONENTS_1(name)                                                        \
  dvec2 name(dvec2 x) { return dvec2(name(x.x), name(x.y)); }                          \
  dvec3 name(dvec3 x) { return dvec3(name(x.x), name(x.y), name(x.z)); }               \
  dvec4 name(dvec4 x) { return dvec4(name(x.x), name(x.y), name(x.z), name(x.w)); }
#define FP64_COMPONENTS_2(name)                                                                              \
  dvec2 name(dvec2 x, dvec2 y) { return dvec2(name(x.x, y.x), name(x.y, y.y)); }                             \
  dvec3 name(dvec3 x, dvec3 y) { return dvec3(name(x.x, y.x), name(x.y, y.y), name(x.z, y.z)); }             \
  dvec4 name(dvec4 x, dvec4 y) { return dvec4(name(x.x, y.x), name(x.y, y.y), name(x.z, y.z), name(x.w, y.w)); }

FP64_COMPONENTS_1(fp64_exp)
FP64_COMPONENTS_1(fp64_exp2)
FP64_COMPONENTS_1(fp64_log)
FP64_COMPONENTS_1(fp64_log2)
FP64_COMPONENTS_1(fp64_sin)
FP64_COMPONENTS_1(fp64_cos)
FP64_COMPONENTS_1(fp64_tan)
FP64_COMPONENTS_1(fp64_asin)
FP64_COMPONENTS_1(fp64_acos)
FP64_COMPONENTS_1(fp64_atan)
FP64_COMPONENTS_1(fp64_sinh)
FP64_COMPONENTS_1(fp64_cosh)
FP64_COMPONENTS_1(fp64_tanh)
FP64_COMPONENTS_1(fp64_radians)
FP64_COMPONENTS_1(fp64_degrees)
FP64_COMPONENTS_2(fp64_pow)
FP64_COMPONENTS_2(fp64_atan)
