// SPDX-License-Identifier: Apache-2.0
// Steps (1998, figure 1): 1 primary image, 2 which mirrors does the level show, 3 what each of them shows,
// into the next level, 4 again for mirrors in mirrors, 5 blend from the last level to the first.
#include "catoptric/renderer/raster_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>

#include "catoptric/core/error.h"
#include "catoptric/core/parallel.h"
#include "catoptric/core/sample_pattern.h"
#include "catoptric/depth_reflection_map/reference_file.h"
#include "catoptric/reflection_morphing/baked_file.h"
#include "catoptric/renderer/near_plane.h"

namespace catoptric::renderer {
namespace {

constexpr int kSmallMapTexels = 32;  // of a mirror that shows a scene within four pixels

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

virtual_object::Solver virtualObjectSolver(Solver solver) {
  switch (solver) {
    case Solver::Explosion:
      return virtual_object::Solver::Explosion;
    case Solver::Layered:
      return virtual_object::Solver::Layered;
    case Solver::Analytic:
      return virtual_object::Solver::Analytic;
    case Solver::Subdivision:
      return virtual_object::Solver::Subdivision;
    default:
      return virtual_object::Solver::Refined;
  }
}

/// Rows are stored bottom first on the GPU, top first in an Image.
template <class Pixel, class Write>
void forFlippedRows(const std::vector<Pixel>& pixels, int width, int height, const Write& write) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      write(x, y, pixels[std::size_t(height - 1 - y) * std::size_t(width) + std::size_t(x)]);
}

void addCounters(const raster::MethodCounters& counters, Frame& frame) {
  frame.timings.lookUpMs += counters.lookUpMs;
  frame.counters.lookedUpVertices += counters.lookedUpVertices;
  frame.counters.morphedTraces = counters.morphedTraces;
  frame.timings.virtualVerticesMs += counters.virtualVerticesMs;
  frame.timings.coverMs += counters.coverMs;
  frame.counters.virtualVertices += counters.virtualVertices;
  frame.counters.culledVertices += counters.culledVertices;
  frame.counters.culledTriangles += counters.culledTriangles;
  frame.counters.simplifiedTriangles += counters.simplifiedTriangles;
  frame.counters.virtualTriangles += counters.virtualTriangles;
  frame.counters.fragmentTests += counters.fragmentTests;
  frame.counters.virtualPixels += counters.virtualPixels;
  frame.counters.boundedPixels += counters.boundedPixels;
  frame.timings.warpMs += counters.warpMs;
  frame.timings.captureMs += counters.captureMs;
  frame.counters.zexels += counters.zexels;
  frame.counters.zexelPixels += counters.zexelPixels;
  frame.counters.uncoveredPixels += counters.uncoveredPixels;
  frame.counters.zexelCaptures += counters.zexelCaptures;
}

}  // namespace

// Without a second array to flip it in.
void readFlipped(const gl::Framebuffer& framebuffer, int attachment, core::ImageRgbaF& image) {
  framebuffer.readPixels(attachment, std::span<vec4>(image.pixels()));
  const std::size_t width = std::size_t(image.width()), height = std::size_t(image.height());
  core::parallelFor((height + 1) / 2, 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      vec4 *upper = image.data() + y * width, *lower = image.data() + (height - 1 - y) * width;
      for (std::size_t x = 0; x < width; ++x) {
        const vec4 swapped = upper[x];
        upper[x] = vec4(vec3(lower[x]), 1.0f);
        lower[x] = vec4(vec3(swapped), 1.0f);
      }
    }
  });
}

double RasterFrame::findNearPlane(const scene::CameraFrame& camera) {
  const scene::CameraFrame& last = nearPlaneCamera_;
  if (nearPlane_ == 0 || last.eye != camera.eye || last.tanHalfFovY != camera.tanHalfFovY ||
      last.widthPx * camera.heightPx != camera.widthPx * last.heightPx) {
    nearPlane_ = chooseNearPlane(geometry_, camera);
    nearPlaneCamera_ = camera;
  }
  return nearPlane_;
}

RasterFrame::RasterFrame(gl::Context& context, const scene::Scene& scene,
                         const scene::WorldGeometry& geometry, const scene::Environment& environment)
    : context_(context),
      sceneData_(scene),
      geometry_(geometry),
      surroundings_(environment),
      scene_(scene, geometry, environment),
      chains_(geometry),
      primary_(surfaces_),
      exact_(hits_),
      virtual_(virtual_object::Solver::Refined, hits_, exact_),
      numbersByGl_(!context.isSoftware()) {
  if (geometry.reflectors.size() >= 0xffffu)
    throw core::Error("renderer.reflectors", "the scene has more than 65534 mirrors", {},
                      "use --reflector NAME to pick some");
}

void RasterFrame::updateGeometry(std::span<const std::uint32_t> movedParts) {
  scene_.updateGeometry(movedParts);
  nearPlane_ = 0;
  hasMoved_ = true;
  chooser_.reset();  // its triangles are out of date, and it is not asked any more
  primary_.geometryChanged();
  hits_.partsMoved(scene_, movedParts);
  for (raster::ReflectionMethod* method : methods_) method->partsMoved(geometry_, movedParts);
}

void RasterFrame::updateMaterials() {
  scene_.updateMaterials();
  hasMoved_ = true;
  for (raster::ReflectionMethod* method : methods_) method->materialsChanged();
}

void RasterFrame::prepareLevels(int count, const FrameOptions& options) {
  const int widthPx = options.widthPx, heightPx = options.heightPx;
  const bool withStencil = options.merge == Merge::Stencil || options.merge == Merge::Erase;
  const auto isUsable = [&](const std::unique_ptr<raster::Level>& level) {
    return level->widthPx == widthPx && level->heightPx == heightPx && level->hasStencil == withStencil;
  };
  if (!std::all_of(levels_.begin(), levels_.end(), isUsable)) levels_.clear();
  while (int(levels_.size()) < count)
    levels_.push_back(std::make_unique<raster::Level>(widthPx, heightPx, withStencil));
}

bool RasterFrame::needsLevelsOfDetail(const FrameOptions& options) const {
  const bool isVirtual = options.method == Method::Auto || options.method == Method::Virtual;
  return isVirtual && options.solver != Solver::Exact && options.solver != Solver::Explosion &&
         scene_.levelsSoFar() == nullptr &&
         std::any_of(geometry_.reflectors.begin(), geometry_.reflectors.end(),
                     [](const scene::Reflector& reflector) {
                       return reflector.isConvex && !reflector.isPlanarMirror() && !reflector.isRefractor();
                     });
}

void RasterFrame::renderSample(const scene::CameraFrame& camera, const FrameOptions& options,
                               const dvec2& jitterPx, Frame& frame) {
  const auto start = std::chrono::steady_clock::now();
  const bool hasRefractors =
      std::any_of(geometry_.reflectors.begin(), geometry_.reflectors.end(),
                  [](const scene::Reflector& reflector) { return reflector.isRefractor(); });
  const int mostLevels =
      options.method == Method::None ? 0 : options.bounces + (hasRefractors ? scene::kMostCrossings : 0);
  raster::MethodCounters counters;
  raster::FrameContext context{.scene = scene_,
                               .camera = camera,
                               .surfaces = surfaces_,
                               .primary = primary_,
                               .compose = compose_,
                               .nearPlane = findNearPlane(camera),
                               .jitterPx = jitterPx,
                               .maxErrorPx = options.method == Method::Auto
                                                 ? std::min(options.maxErrorPx, kCoarsestPx)
                                                 : options.maxErrorPx,
                               .merge = options.merge,
                               .textureScale = options.textureScale,
                               .allParts = options.allParts,
                               .counters = counters};

  // 1
  levels_[0]->withSeen = options.withSeen || options.drawsSeen;
  levels_[0]->composesSeen = options.withSeen;
  levels_[0]->isLast = mostLevels == 0;
  levels_[0]->withIds = mostLevels > 0;
  std::future<void> levelsOfDetail;  // made while GL compiles and draws, once a scene
  if (mostLevels > 0 && needsLevelsOfDetail(options))
    levelsOfDetail = std::async(std::launch::async, [this] { static_cast<void>(scene_.levels()); });
  primary_.draw(scene_, camera, context.nearPlane, jitterPx, *levels_[0]);
  context_.finish();
  if (levelsOfDetail.valid()) levelsOfDetail.get();
  frame.timings.primaryMs += millisecondsSince(start);

  chains_.beginFrame();
  lastMethods_.clear();
  for (raster::ReflectionMethod* method : methods_)
    if (method != &morphing_ || options.method == Method::Morphing) method->prepare(context);
  const int levelCount = renderLevels(context, options, mostLevels);

  // 5
  for (int level = levelCount - 1; level >= 0; --level)
    compose_.draw(*levels_[std::size_t(level)],
                  level + 1 < levelCount ? levels_[std::size_t(level) + 1].get() : nullptr);
  context_.finish();
  context_.check("a frame");
  frame.timings.totalMs += millisecondsSince(start);
  frame.timings.reflectionMs = frame.timings.totalMs - frame.timings.primaryMs;
  addCounters(counters, frame);
  frame.counters.reflectorsDrawn = lastMirrors_;
  frame.counters.reflectorsCulled = geometry_.reflectors.size() - lastMirrors_;
}

bool RasterFrame::findsVerticesOnGpu(const FrameOptions& options) const {
  if (options.backend == Backend::Cpu) return false;
  if (options.backend == Backend::Auto) return !context_.isSoftware() && hasVertexShader(options.solver);
  if (!hasVertexShader(options.solver))
    throw core::Error("renderer.backend",
                      fmt::format("solver '{}' has no vertex shader", solverName(options.solver)), {},
                      "use backend cpu, or solver explosion, layered or refined");
  return true;
}

void RasterFrame::prepareMorphing(const dvec3& eye, const FrameOptions& options) {
  using namespace reflection_morphing;
  morphing_.setDynamic(options.allDynamic);
  if (!options.bakedFile.empty()) {
    if (morphing_.hasSource() && options.bakedFile == morphingFile_) return;
    const auto file = std::make_shared<BakedFile>(options.bakedFile);
    file->checkScene(geometry_);
    morphing_.setSource(file);
  } else {
    BakePlan plan = makePlanAround(geometry_, eye);
    plan.options.map.bounces = std::max(options.bounces, 1);
    // Of a finer grid than is needed no eye within it asks for another one.
    const bool fits = morphing_.hasSource() && morphingFile_.empty() && morphingPlan_.grid.findCell(eye) &&
                      morphingPlan_.grid.spacing().x <= 1.001 * plan.grid.spacing().x &&
                      morphingPlan_.options.map.bounces == plan.options.map.bounces;
    if (fits) return;
    morphing_.setSource(std::make_shared<OnTheFly>(geometry_, plan));
    morphingPlan_ = plan;
  }
  morphingFile_ = options.bakedFile;
}

void RasterFrame::prepareZexels(const FrameOptions& options) {
  const std::string& file = options.zexel.cacheFile;
  if (file == zexelFile_ || hasMoved_) return;
  if (!file.empty())
    zexel_.useCacheFile(file,
                        depth_reflection_map::computeSceneFingerprint(sceneData_, geometry_, surroundings_));
  zexelFile_ = file;
}

void RasterFrame::readSeen(const raster::Level& level, Frame& frame) const {
  const int width = level.widthPx, height = level.heightPx;
  std::vector<vec4> points(std::size_t(width) * std::size_t(height));
  std::vector<uvec2> ids(points.size());
  level.seen.readPixels(0, std::span<vec4>(points));
  level.seen.readPixels(1, std::span<uvec2>(ids));
  frame.seen = core::SeenImage(width, height);
  forFlippedRows(points, width, height, [&](int x, int y, const vec4& p) {
    core::SeenPixel& seen = frame.seen.at(x, y);
    seen.point = vec3(p);
    seen.pathLength = p.w;
  });
  forFlippedRows(ids, width, height, [&](int x, int y, const uvec2& id) {
    core::SeenPixel& seen = frame.seen.at(x, y);
    const std::uint32_t object = id.x & 0x3fffffffu, reflector = id.y & 0xffffu;
    seen.object = object == 0 ? core::kNoId : object - 1;
    seen.shell = id.x >> 31;
    seen.firstReflector = reflector == 0 ? core::kNoId : reflector - 1;
    seen.bounces = id.y >> 16;
    if (seen.isSky()) seen.pathLength = std::numeric_limits<float>::infinity();
  });
}

Frame RasterFrame::render(const scene::CameraFrame& camera, const FrameOptions& options) {
  Frame frame;
  const int samples = std::max(1, options.samples);
  prepareLevels(1, options);
  virtual_.setSolver(virtualObjectSolver(options.solver), findsVerticesOnGpu(options), numbersByGl_);
  exact_.testByGl(numbersByGl_);
  if (options.method == Method::Morphing) prepareMorphing(camera.eye, options);
  zexel_.setOptions(options.zexel);
  if (options.method == Method::Zexel) prepareZexels(options);
  environment_.setOptions(options.environmentMapSize, options.boxCorrected);
  smallMaps_.setOptions(kSmallMapTexels, true);
  frame.radiance = core::ImageRgbaF(options.widthPx, options.heightPx, vec4(0, 0, 0, 1));
  const raster::Level& level = *levels_[0];
  std::vector<vec4> pixels(samples == 1 ? 0 : frame.radiance.size());
  for (int i = 0; i < samples; ++i) {
    renderSample(camera, options, core::samplePosition(i, samples), frame);
    if (samples == 1) {
      readFlipped(level.composed, 0, frame.radiance);
      break;
    }
    level.composed.readPixels(0, std::span<vec4>(pixels));
    forFlippedRows(pixels, options.widthPx, options.heightPx, [&](int x, int y, const vec4& p) {
      frame.radiance.at(x, y) += vec4(vec3(p) / float(samples), 0.0f);
    });
  }
  if (options.withSeen) {
    if (samples > 1) {  // what is seen is sampled at the pixel centre; its time is not the frame's
      Frame centre;
      renderSample(camera, options, dvec2(0.5, 0.5), centre);
    }
    readSeen(level, frame);
  }
  if (options.method == Method::Auto && !hasMoved_)
    for (const auto& [reflector, chosen] : chosen_) frame.choices.emplace(reflector, chosen.choice);
  return frame;
}

}  // namespace catoptric::renderer
