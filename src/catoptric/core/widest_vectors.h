// SPDX-License-Identifier: Apache-2.0
// Loops over lanes, written once and compiled twice: for the processors that everyone has and for AVX2. Which
// one runs is decided when the program runs.
//
// Products and sums are not fused (see cmake/catoptric_library.cmake), so both give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__)
#define CATOPTRIC_HAS_AVX2_CLONE
#endif

/// Of everything that a function for runOnWidestVectors() calls: what is not inlined is compiled for the
/// processors that everyone has.
#define CATOPTRIC_INLINE __attribute__((always_inline)) inline

namespace catoptric::core {

#ifdef CATOPTRIC_HAS_AVX2_CLONE
inline const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

template <class Function, class... Arguments>
__attribute__((target("avx2"))) void runWithAvx2(Arguments&... arguments) {
  Function::run(arguments...);
}
#endif

template <class Function, class... Arguments>
void runAnywhere(Arguments&... arguments) {
  Function::run(arguments...);
}

/// Calls Function::run(arguments...), a static function that is CATOPTRIC_INLINE.
template <class Function, class... Arguments>
void runOnWidestVectors(Arguments&... arguments) {
#ifdef CATOPTRIC_HAS_AVX2_CLONE
  if (kHasAvx2) return runWithAvx2<Function>(arguments...);
#endif
  runAnywhere<Function>(arguments...);
}

}  // namespace catoptric::core
