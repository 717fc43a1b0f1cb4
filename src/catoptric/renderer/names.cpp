// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/frame.h"

namespace catoptric::renderer {

std::string_view methodName(Method method) {
  switch (method) {
    case Method::Auto:
      return "auto";
    case Method::None:
      return "none";
    case Method::Environment:
      return "environment";
    case Method::Virtual:
      return "virtual";
    case Method::Morphing:
      return "morphing";
    case Method::Zexel:
      return "zexel";
    case Method::RayTrace:
      return "raytrace";
  }
  return "?";
}

bool hasSolvers(Method method) {
  return method == Method::Auto || method == Method::Virtual;
}

std::string_view solverName(Solver solver) {
  switch (solver) {
    case Solver::Auto:
      return "auto";
    case Solver::Explosion:
      return "explosion";
    case Solver::Layered:
      return "layered";
    case Solver::Refined:
      return "refined";
    case Solver::Analytic:
      return "analytic";
    case Solver::Subdivision:
      return "subdivision";
    case Solver::Exact:
      return "exact";
  }
  return "?";
}

std::string_view backendName(Backend backend) {
  switch (backend) {
    case Backend::Auto:
      return "auto";
    case Backend::Cpu:
      return "cpu";
    case Backend::Gpu:
      return "gpu";
  }
  return "?";
}

bool hasVertexShader(Solver solver) {
  return solver == Solver::Auto || solver == Solver::Explosion || solver == Solver::Layered ||
         solver == Solver::Refined;
}

bool hasMerges(Method method) {
  return method != Method::None && method != Method::Environment && method != Method::RayTrace;
}

std::string_view mergeName(Merge merge) {
  switch (merge) {
    case Merge::Ids:
      return "ids";
    case Merge::Stencil:
      return "stencil";
    case Merge::Erase:
      return "erase";
    case Merge::Depth:
      return "depth";
    case Merge::Clip:
      return "clip";
    case Merge::Texture:
      return "texture";
  }
  return "?";
}

}  // namespace catoptric::renderer
