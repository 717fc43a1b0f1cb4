// SPDX-License-Identifier: Apache-2.0
// VirtualObjectMethod with virtual vertices found by a vertex shader.
//
// Steps: 1 once for a mirror, tessellated objects and mirror triangles as buffers and textures; 2 for a new
// eye, explosion maps, hidden map (by the processor) into textures; 3 all triangles of the objects drawn with
// virtual_surface.vert, which finds each vertex's reflection point by itself; fragments of triangles that are
// not worth drawing leave (raster/placed_triangle.glsl); 4 blended parts have to be sorted by virtual
// vertices: those alone are found by the processor.
// Nothing but maps goes over the bus, and those only when the eye has moved. Triangles are shaded where they
// are drawn, as in 1998, whatever the solver: to draw numbers and read them back (numbered_triangles.h) would
// wait for the GPU.
#include <algorithm>
#include <array>

#include "catoptric/core/log.h"
#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kSeedLayers = 4;  // of Refined: what Newton starts from is about a pixel off

int countLayers(Solver solver) {
  return solver == Solver::Explosion ? 2 : solver == Solver::Refined ? kSeedLayers : kDefaultLayers;
}

double determinantSign(const dmat4& m) {
  return glm::determinant(dmat3(m)) < 0.0 ? -1.0 : 1.0;
}

}  // namespace

bool VirtualObjectMethod::usesGpu(const Prepared& p) const {
  if (!onGpu_ || !hasVertexShader(solver_)) return false;
  if (MirrorTextures::fits(p.mesh, countLayers(solver_))) return true;
  core::logWarningOnce("a mirror has too many triangles for this GL's textures: backend cpu in place of gpu");
  return false;
}

/// Steps 1 and 2.
void VirtualObjectMethod::prepareTextures(const raster::FrameContext& frame, Prepared& p) const {
  if (!p.gpu) {
    p.gpu = std::make_unique<OnGpu>(p.objects);
    p.gpu->blendedRuns.assign(p.runs.runs(), 0);
    for (const raster::TessellatedPart& part : p.objects.parts) {
      if (!frame.scene.isBlended(part.part) || part.vertexCount == 0) continue;
      p.gpu->hasBlended = true;
      const std::size_t first = part.firstVertex / VertexRuns::kLength,
                        last = (part.firstVertex + part.vertexCount - 1) / VertexRuns::kLength;
      for (std::size_t run = first; run <= last; ++run) p.gpu->blendedRuns[run] = 1;
    }
  }
  OnGpu& gpu = *p.gpu;
  if (!gpu.textures || gpu.texturesOf != solver_) {
    const int layers = countLayers(solver_);
    gpu.textures = std::make_unique<MirrorTextures>(p.mesh, layers);
    gpu.layers = solver_ == Solver::Explosion ? nullptr : std::make_unique<LayeredFinder>(p.mesh, layers);
    gpu.texturesOf = solver_;
    gpu.eye.reset();
  }
  if (gpu.eye == p.solver->eye()) return;
  const EyeView view = p.solver->eyeView();
  std::vector<const ExplosionMap*> maps;
  if (gpu.layers) {
    gpu.layers->setEye(view);
    for (const ExplosionMap& map : gpu.layers->layers()) maps.push_back(&map);
  } else {
    maps = {&p.solver->nearMap(), &p.solver->farMap()};
  }
  gpu.textures->setEye(view, maps, p.solver->hiddenMap());
  gpu.eye = p.solver->eye();
}

void VirtualObjectMethod::drawOnGpu(raster::FrameContext& frame, const raster::Chain& chain,
                                    const raster::SurfaceView& view, Prepared& p, raster::Level& target) {
  prepareTextures(frame, p);
  // 3
  std::unique_ptr<raster::SurfacePass>& surfaces = gpuSurfaces_[solver_];
  if (!surfaces)
    surfaces = std::make_unique<raster::SurfacePass>("virtual_object/virtual_surface.vert",
                                                     vertexShaderDefines(solver_));
  raster::SurfaceView placed = view;
  const MirrorTextures& textures = *p.gpu->textures;
  placed.bindVertexShader = [&textures, &chain](gl::Program& program) {
    textures.bind(program);
    program.set("u_drawFromWorld", mat4(chain.drawFromWorld));
    program.set("u_orientation",
                float(determinantSign(chain.screenFromDraw) * determinantSign(chain.drawFromWorld)));
  };
  ranges_.clear();
  for (const raster::TessellatedPart& part : p.objects.parts)
    if (!frame.scene.isBlended(part.part)) {
      ranges_.push_back({part.part, part.firstIndex, part.indexCount});
      frame.counters.virtualVertices += part.vertexCount;
      frame.counters.virtualTriangles += part.indexCount / 3;
    }
  raster::sortNearFirst(frame.scene, frame.scene.geometry().reflectors[chain.last].centre, ranges_);
  surfaces->draw(frame.scene, p.gpu->streams, ranges_, placed, target);
  // 4
  p.isFoundOnCpu = false;
  if (p.gpu->hasBlended) drawBlended(frame, chain, view, p, target);
}

void VirtualObjectMethod::drawBlended(raster::FrameContext& frame, const raster::Chain& chain,
                                      const raster::SurfaceView& view, Prepared& p, raster::Level& target) {
  computeVirtualVertices(frame, chain, p, p.gpu->blendedRuns);
  const bool isMirrored = chain.drawFromWorld != dmat4(1.0);
  raster::markVirtualTriangles(p.objects, view.drawEye, p.virtualPositions, p.kinds, p.reflectionPoints,
                               triangles_,
                               isMirrored ? std::span<const vec3>(p.scenePoints) : std::span<const vec3>());
  std::vector<std::uint8_t> isWanted(frame.scene.geometry().parts.size());
  for (std::uint32_t i = 0; i < isWanted.size(); ++i) isWanted[i] = frame.scene.isBlended(i) ? 1 : 0;
  raster::gatherVirtualTriangles(p.objects, p.objects.indices, isWanted, triangles_);
  frame.counters.virtualTriangles += triangles_.indices.size() / 3;
  p.pass.drawSelected(frame, view, p.virtualPositions, triangles_, target);
}

}  // namespace catoptric::virtual_object
