// Gaussian noise: Philox4x32-10 (Salmon et al. 2011) and Box-Muller. The elementary functions are written
// here, because those of the C library differ in the last bit between machines. The code uses vectors of
// 64-bit lanes, because compilers vectorise 32-bit products badly. A word of the generator is the lower half
// of a lane; the upper half is masked before it is used.
#include <immintrin.h>

#include "core/kernels/level.h"
#include "core/kernels/philox.h"
#include "core/kernels/point_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

// Operations on one native vector: the products of the lower halves of lanes, the square roots of lanes, and
// the signs of lanes as a mask.
#if defined(__AVX512F__)
using Part = __m512i;
inline Part product(Part a, Part b) {
  return _mm512_mul_epu32(a, b);
}
inline Part root(Part a) {
  return _mm512_castpd_si512(_mm512_sqrt_pd(_mm512_castsi512_pd(a)));
}
inline unsigned signs(Part a) {
  return _mm512_movepi64_mask(a);
}
#elif defined(__AVX2__)
using Part = __m256i;
inline Part product(Part a, Part b) {
  return _mm256_mul_epu32(a, b);
}
inline Part root(Part a) {
  return _mm256_castpd_si256(_mm256_sqrt_pd(_mm256_castsi256_pd(a)));
}
inline unsigned signs(Part a) {
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(a)));
}
#else
using Part = __m128i;
inline Part product(Part a, Part b) {
  return _mm_mul_epu32(a, b);
}
inline Part root(Part a) {
  return _mm_castpd_si128(_mm_sqrt_pd(_mm_castsi128_pd(a)));
}
inline unsigned signs(Part a) {
  return static_cast<unsigned>(_mm_movemask_pd(_mm_castsi128_pd(a)));
}
#endif

constexpr std::size_t kNative = sizeof(Part) / 8;
using NativeBits __attribute__((vector_size(sizeof(Part)))) = std::uint64_t;

// The normals are computed in two native vectors side by side: with one, the machine would wait for each
// result in the long chain of operations.
constexpr std::size_t kWidth = 2 * kNative;
using Lanes __attribute__((vector_size(2 * sizeof(Part)))) = double;
using Bits __attribute__((vector_size(2 * sizeof(Part)))) = std::uint64_t;
struct Parts {
  Part part[2];
};

inline NativeBits product(NativeBits a, NativeBits b) {
  return (NativeBits)product((Part)a, (Part)b);
}
// The vector is copied, not cast, because g++ 12 then compiles better AVX2 code.
template <class Vector>
inline Parts split(const Vector& vector) {
  Parts parts;
  __builtin_memcpy(&parts, &vector, sizeof parts);
  return parts;
}
template <class Vector>
inline Vector join(const Parts& parts) {
  Vector vector;
  __builtin_memcpy(&vector, &parts, sizeof parts);
  return vector;
}

inline Bits product(Bits a, Bits b) {
  Parts x = split(a), y = split(b);
  for (int i = 0; i < 2; ++i) x.part[i] = product(x.part[i], y.part[i]);
  return join<Bits>(x);
}
struct Product {
  template <class Vector>
  static Vector of(Vector a, Vector b) {
    return product(a, b);
  }
};
inline Lanes root(Lanes a) {
  Parts x = split(a);
  for (Part& part : x.part) part = root(part);
  return join<Lanes>(x);
}

constexpr Bits kNone = {};

using Half __attribute__((vector_size(sizeof(Bits) / 2))) = std::uint32_t;

// Loads the first `live` words; the other lanes are 0.
inline Bits load(const std::uint32_t* words, std::size_t live) {
  Half half = {};
  if (live == kWidth)
    __builtin_memcpy(&half, words, sizeof half);
  else
    for (std::size_t i = 0; i < live; ++i) half[i] = words[i];
  return __builtin_convertvector(half, Bits);
}

// Converts whole numbers below 2^51 in magnitude to doubles: added to the bits of 1.5 * 2^52, they are its
// last digits.
inline Lanes number(Bits whole) {
  return (Lanes)(whole + 0x4338000000000000u) - 0x1.8p52;
}

// Returns ln u for u in (0, 1], with a relative error of 1e-15: u = m 2^e with m in [2/3, 4/3), ln m = 2
// artanh((m - 1)/(m + 1)).
inline Lanes logarithm(Lanes u) {
  const Bits bits = (Bits)u;
  // The exponent of u relative to 2/3, from -33 to 0, as a signed number of twelve bits.
  const Bits exponent = (((bits - 0x3FE5555555555555u) >> 52) ^ 0x800u) - 0x800u;
  const Lanes m = (Lanes)(bits - (exponent << 52));
  const Lanes s = (m - 1.0) / (m + 1.0), s2 = s * s;
  Lanes series = s2 * (1.0 / 23.0) + 1.0 / 21.0;
  series = series * s2 + 1.0 / 19.0, series = series * s2 + 1.0 / 17.0;
  series = series * s2 + 1.0 / 15.0, series = series * s2 + 1.0 / 13.0, series = series * s2 + 1.0 / 11.0;
  series = series * s2 + 1.0 / 9.0, series = series * s2 + 1.0 / 7.0, series = series * s2 + 1.0 / 5.0;
  series = series * s2 + 1.0 / 3.0, series = series * s2 + 1.0;
  return number(exponent) * 0.6931471805599453 + 2.0 * s * series;
}

// Returns the radius of a Box-Muller pair. u = (k + 1) 2^-32 is in (0, 1], so the radius is at most sqrt(64
// ln 2) = 6.6605. This hard bound lets a scenario skip points that cannot come near.
inline Lanes gaussian_radius(Bits k) {
  return root(-2.0 * logarithm(number(k + 1) * 0x1p-32));
}

inline Lanes choose(Bits mask, Lanes set, Lanes clear) {
  return (Lanes)((mask & (Bits)set) | (~mask & (Bits)clear));
}

inline void store(Lanes lanes, double* to, std::size_t live) {
  if (live == kWidth)
    __builtin_memcpy(to, &lanes, sizeof lanes);
  else
    for (std::size_t i = 0; i < live; ++i) to[i] = lanes[i];
}

struct SineCosine {
  Lanes sine, cosine;
};

// Returns sine and cosine of 2 pi k / 2^32: subtracts the nearest multiple of a quarter turn, then uses
// Taylor series on [-pi/4, pi/4].
inline SineCosine sine_cosine(Bits k) {
  const Bits quarter = (k + 0x20000000u) >> 30;
  const Lanes a = number(k - (quarter << 30)) * (6.283185307179586 * 0x1p-32), a2 = a * a;
  Lanes s = a2 * (-1.0 / 1307674368000.0), c = a2 * (-1.0 / 87178291200.0);
  s = s + 1.0 / 6227020800.0, s = s * a2 - 1.0 / 39916800.0, s = s * a2 + 1.0 / 362880.0;
  s = s * a2 - 1.0 / 5040.0, s = s * a2 + 1.0 / 120.0, s = s * a2 - 1.0 / 6.0, s = (s * a2 + 1.0) * a;
  c = c + 1.0 / 479001600.0, c = c * a2 - 1.0 / 3628800.0, c = c * a2 + 1.0 / 40320.0;
  c = c * a2 - 1.0 / 720.0, c = c * a2 + 1.0 / 24.0, c = c * a2 - 0.5, c = c * a2 + 1.0;
  const Bits odd = kNone - (quarter & 1u);  // all ones if the number of quarter turns is odd
  const Bits sine_sign = (quarter & 2u) << 62, cosine_sign = ((quarter + 1u) & 2u) << 62;
  return {(Lanes)((Bits)choose(odd, c, s) ^ sine_sign), (Lanes)((Bits)choose(odd, s, c) ^ cosine_sign)};
}

// The upper bit of a lane is set if the words of one normal, of its radius and of its angle, do not satisfy
// the bounds. A cosine is negative for angles from a quarter to three quarters of a turn.
inline NativeBits refused(NativeBits radius, NativeBits angle, NativeBits bounds) {
  const NativeBits negative = (angle + 0x40000000u) << 32;
  return ((bounds & kWord) - radius) | ((negative ^ (bounds << 1)) & bounds);
}

// Appends first + k for the lanes k < live that are not refused. Returns their number.
inline std::size_t keep(NativeBits refused, std::uint32_t first, std::size_t live, std::uint32_t* index) {
  const unsigned kept = ~signs((Part)refused) & ((1u << live) - 1);
#if defined(__AVX512F__)
  const __m256i lanes =
      _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32(static_cast<int>(first)));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(index),
                      _mm256_maskz_compress_epi32(static_cast<__mmask8>(kept), lanes));
  return static_cast<std::size_t>(__builtin_popcount(kept));
#else
  std::size_t found = 0;
  for (std::size_t k = 0; k < live; ++k) {
    index[found] = first + static_cast<std::uint32_t>(k);
    found += kept >> k & 1;
  }
  return found;
#endif
}

// The number of vectors whose words are computed side by side when points are selected. More vectors would
// need more registers than a processor has.
constexpr std::size_t kTogether = kNative == 8 ? 4 : 2;

// A walk over a rectangle of points, row by row, one vector at a time. The last vector of a row may have
// lanes without a point. first(): index of the point in lane 0. live(): number of lanes with a point.
struct Walk {
  const PointRectangle& points;
  std::size_t row = 0, column = 0;
  std::uint32_t first() const {
    return points.first + static_cast<std::uint32_t>(row) * points.stride +
           static_cast<std::uint32_t>(column);
  }
  std::size_t live() const { return points.columns - column < kNative ? points.columns - column : kNative; }
  void advance() {
    column += kNative;
    if (column >= points.columns) column = 0, ++row;
  }
};

}  // namespace

void normals(const NoiseStream& stream, const std::uint32_t* index, std::size_t count, double* x, double* y,
             double* z) {
  const Philox<Bits, Product> philox(stream);
  for (std::size_t i = 0; i < count; i += kWidth) {
    const std::size_t live = count - i < kWidth ? count - i : kWidth;
    const Words<Bits> words = philox(load(index + i, live));
    const SineCosine turn = sine_cosine(words.w[1]);
    const Lanes radius = gaussian_radius(words.w[0]);
    store(radius * turn.cosine, x + i, live);
    store(radius * turn.sine, y + i, live);
    store(gaussian_radius(words.w[2]) * sine_cosine(words.w[3]).cosine, z + i, live);
  }
}

std::size_t candidates(const NoiseStream& stream, const PointRectangle& points, const std::uint64_t* x,
                       const std::uint64_t* z, std::uint32_t* index) {
  const Philox<NativeBits, Product> philox(stream);
  const NativeBits none = {};
  NativeBits lane = {};
  for (std::size_t i = 0; i < kNative; ++i) lane[i] = i;
  std::size_t found = 0;
  Walk made{points}, tested{points};
  for (std::size_t left = points.rows * ((points.columns + kNative - 1) / kNative); left > 0;) {
    NativeBits group[kTogether];
    Words<NativeBits> words[kTogether];
    for (NativeBits& vector : group) {
      vector = lane + made.first();
      made.advance();
    }
    philox.compute(group, words);
    for (std::size_t k = 0; k < kTogether && left > 0; ++k, --left) {
      const NativeBits(&w)[4] = words[k].w;
      NativeBits bounds;
      __builtin_memcpy(&bounds, x + tested.column, sizeof bounds);
      const NativeBits no = refused(w[0], w[1], bounds) | refused(w[2], w[3], none + z[tested.row]);
      found += keep(no, tested.first(), tested.live(), index + found);
      tested.advance();
    }
  }
  return found;
}

const NoiseKernels kNoiseKernels = {.normals = normals, .candidates = candidates};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
