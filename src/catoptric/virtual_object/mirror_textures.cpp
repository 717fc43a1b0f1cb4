// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mirror_textures.h"

#include <algorithm>
#include <cassert>

#include "catoptric/core/parallel.h"
#include "catoptric/raster/scene_buffers.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kTableWidth = 2048;
constexpr std::size_t kTriangleTexels = 6, kMapTexels = 3;
constexpr int kFirstUnit = raster::kUnitFirstFree + 4;  // behind the images of the level before

int tableHeight(std::size_t texels) {
  return int(std::max<std::size_t>(1, (texels + kTableWidth - 1) / kTableWidth));
}

template <class Texel>
std::unique_ptr<gl::Texture> makeTable(gl::Format format, std::size_t texels, std::vector<Texel>* filled) {
  const int height = tableHeight(texels);
  auto table = std::make_unique<gl::Texture>(gl::TextureKind::Flat, format, kTableWidth, height, 1, 1,
                                             gl::SamplerState{});
  if (filled != nullptr) {
    filled->resize(std::size_t(kTableWidth) * std::size_t(height));
    table->upload(0, 0, filled->data());
  }
  return table;
}

}  // namespace

std::vector<std::string> vertexShaderDefines(Solver solver) {
  assert(hasVertexShader(solver));
  if (solver == Solver::Explosion) return {"EXPLOSION"};
  if (solver == Solver::Refined) return {"REFINED"};
  return {};
}

bool MirrorTextures::fits(const ReflectorMesh& mesh, int layers) {
  const std::size_t triangles = mesh.triangles().size();
  const std::size_t most = triangles * std::max(kTriangleTexels, kMapTexels * std::size_t(layers));
  return kTableWidth <= gl::maxTextureSize() && tableHeight(most) <= gl::maxTextureSize();
}

MirrorTextures::MirrorTextures(const ReflectorMesh& mesh, int layers) : mesh_(&mesh), layers_(layers) {
  assert(layers >= 2 && layers <= kMostLayers);
  uploadTriangles();
}

void MirrorTextures::uploadTriangles() {
  const auto triangles = mesh_->triangles();
  std::vector<vec4> texels(kTriangleTexels * triangles.size());
  std::vector<uvec4> links(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const MirrorTriangle& t = triangles[i];
    vec4* out = &texels[kTriangleTexels * i];
    out[0] = vec4(vec3(t.position0 - mesh_->centre()), float(t.gram11));
    out[1] = vec4(vec3(t.edge1), float(t.gram12));
    out[2] = vec4(vec3(t.edge2), float(t.gram22));
    out[3] = vec4(vec3(t.normal0), 0.0f);
    out[4] = vec4(vec3(t.normal1), 0.0f);
    out[5] = vec4(vec3(t.normal2), 0.0f);
    links[i] = {t.neighbours[0], t.neighbours[1], t.neighbours[2], t.flags};
  }
  triangles_ = makeTable(gl::Format::Rgba32F, texels.size(), &texels);
  neighbours_ = makeTable(gl::Format::Rgba32Ui, links.size(), &links);
  texels_.resize(kMapTexels * triangles.size() * std::size_t(layers_));
  mapTriangles_ = makeTable<vec4>(gl::Format::Rgba32F, texels_.size(), nullptr);
  texels_.resize(std::size_t(kTableWidth) * std::size_t(mapTriangles_->height()));
}

void MirrorTextures::fillMapTriangles(std::size_t layer, const ExplosionMap& map) {
  const std::size_t count = mesh_->triangles().size();
  if (map.coords.empty() || map.uvFromCoords.size() < count) return;
  for (std::size_t i = 0; i < count; ++i) {
    const UvFromCoords& f = map.uvFromCoords[i];
    const vec2 a(map.coords[mesh_->corners()[3 * i]]), b(map.coords[mesh_->corners()[3 * i + 1]]),
        c(map.coords[mesh_->corners()[3 * i + 2]]);
    vec4* out = &texels_[kMapTexels * (layer * count + i)];
    out[0] = vec4(f.u0, f.ux, f.uy, f.v0);
    out[1] = vec4(f.vx, f.vy, a.x, a.y);
    out[2] = vec4(b.x, b.y, c.x, c.y);
  }
}

void MirrorTextures::setEye(const EyeView& view, std::span<const ExplosionMap* const> maps,
                            const HiddenMap& hidden) {
  assert(int(maps.size()) == layers_);
  const ExplosionMap& first = *maps[0];
  const int size = first.ids.width();
  if (!mapIds_ || mapIds_->width() != size)
    mapIds_ = std::make_unique<gl::Texture>(gl::TextureKind::Array, gl::Format::R32Ui, size, size, layers_, 1,
                                            gl::SamplerState{});
  for (int i = 0; i < layers_; ++i) {
    const ExplosionMap& map = *maps[std::size_t(i)];
    mapIds_->upload(0, i, map.ids.data());
    extensionCentres_[std::size_t(i)] = vec4(vec2(map.extensionCentre), 0.0f, 0.0f);
  }
  core::parallelFor(maps.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fillMapTriangles(i, *maps[i]);
  });
  mapTriangles_->upload(0, 0, texels_.data());
  if (!hiddenIds_ || hiddenIds_->width() != hidden.ids.width())
    hiddenIds_ = std::make_unique<gl::Texture>(gl::TextureKind::Flat, gl::Format::R32Ui, hidden.ids.width(),
                                               hidden.ids.height(), 1, 1, gl::SamplerState{});
  hiddenIds_->upload(0, 0, hidden.ids.data());

  const double inverseNear = 1.0 / view.nearRadius, inverseFar = 1.0 / view.farRadius;
  const double steps = double(layers_ - 1);
  mapLayers_ = vec3(dvec3(inverseNear, steps / (inverseFar - inverseNear), steps));
  eye_ = vec3(view.eye - mesh_->centre());
  mapFrame_ = first.frame;
  hiddenFrame_ = hidden.frame;
  hiddenPixels_ = vec4(dvec4(hidden.lower, hidden.pixelsPerUnit));
  hiddenCone_ = vec2(dvec2(std::min(hidden.nearest, 1e30), hidden.squaredCosine));
}

void MirrorTextures::bind(gl::Program& program) const {
  const std::array<std::pair<const char*, const gl::Texture*>, 5> textures{
      {{"u_mapIds", mapIds_.get()},
       {"u_mapTriangles", mapTriangles_.get()},
       {"u_mirrorTriangles", triangles_.get()},
       {"u_mirrorNeighbours", neighbours_.get()},
       {"u_hiddenIds", hiddenIds_.get()}}};
  int unit = kFirstUnit;
  for (const auto& [name, texture] : textures) {
    texture->bind(unit);
    program.set(name, unit++);
  }
  const std::array<std::pair<const char*, vec3>, 9> vectors{{{"u_mapX", vec3(mapFrame_.x)},
                                                             {"u_mapY", vec3(mapFrame_.y)},
                                                             {"u_mapZ", vec3(mapFrame_.z)},
                                                             {"u_hiddenX", vec3(hiddenFrame_.x)},
                                                             {"u_hiddenY", vec3(hiddenFrame_.y)},
                                                             {"u_hiddenZ", vec3(hiddenFrame_.z)},
                                                             {"u_mapLayers", mapLayers_},
                                                             {"u_mirrorEye", eye_},
                                                             {"u_mirrorCentre", vec3(mesh_->centre())}}};
  for (const auto& [name, value] : vectors) program.set(name, value);
  program.set("u_extensionCentres", std::span<const vec4>(extensionCentres_));
  program.set("u_hiddenPixels", hiddenPixels_);
  program.set("u_hiddenCone", hiddenCone_);
  program.set("u_mirrorRadius", float(mesh_->radius()));
  program.set("u_mirrorTriangleCount", int(mesh_->triangles().size()));
  program.set("u_mirrorIsConvex", mesh_->isConvex() ? 1 : 0);
}

}  // namespace catoptric::virtual_object
