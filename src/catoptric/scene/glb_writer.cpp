// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/glb_writer.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "catoptric/core/image_io.h"
#include "catoptric/core/parallel.h"
#include "catoptric/scene/glb_material.h"

namespace catoptric::scene {
namespace {

using Json = nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;

bool isOpaque(const core::ImageRgba8& image) {
  return std::all_of(image.pixels().begin(), image.pixels().end(),
                     [](const glm::u8vec4& p) { return p.a == 255; });
}

struct EncodedImage {
  bool isJpeg = false;
  std::vector<std::byte> bytes;
};

/// Of all textures at once: one after the other they take as long as all else.
std::vector<EncodedImage> encodeImages(std::span<const Texture> textures, const GlbOptions& options) {
  std::vector<EncodedImage> images(textures.size());
  core::parallelFor(images.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const core::ImageRgba8& image = textures[i].image;
      images[i].isJpeg =
          options.jpegFromPixels > 0 && image.size() >= options.jpegFromPixels && isOpaque(image);
      images[i].bytes =
          images[i].isJpeg ? core::encodeJpeg(image, options.jpegQuality) : core::encodePng(image);
    }
  });
  return images;
}

class GlbBuilder {
 public:
  GlbBuilder(const Scene& scene, const GlbOptions& options) : scene_(scene), options_(options) {}

  std::vector<std::byte> build() {
    document_["asset"] = {{"version", "2.0"}, {"generator", options_.generator}};
    const std::vector<EncodedImage> images = encodeImages(scene_.textures, options_);
    for (std::size_t i = 0; i < images.size(); ++i) addTexture(scene_.textures[i], images[i]);
    for (const Material& material : scene_.materials)
      document_["materials"].push_back(makeMaterialJson(material, used_));
    for (const Mesh& mesh : scene_.meshes) addMesh(mesh);
    for (const Instance& instance : scene_.instances) addInstance(instance);
    for (const Light& light : scene_.lights) addLight(light);
    for (const Camera& camera : scene_.cameras) addCamera(camera);
    for (const Animation& animation : scene_.motion.animations) addAnimation(animation);
    finishScene();
    return assemble();
  }

 private:
  std::size_t addView(std::span<const std::byte> bytes, int target) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    binary_.insert(binary_.end(), bytes.begin(), bytes.end());
    document_["bufferViews"].push_back(view);
    return document_["bufferViews"].size() - 1;
  }

  template <class Element>
  std::size_t addAccessor(const std::vector<Element>& values, const char* type, int componentType,
                          int target) {
    const std::size_t view = addView(std::as_bytes(std::span<const Element>(values)), target);
    document_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", componentType}, {"count", values.size()}, {"type", type}});
    return document_["accessors"].size() - 1;
  }

  std::size_t addPositions(const std::vector<vec3>& positions) {
    const std::size_t accessor = addAccessor(positions, "VEC3", kFloat, kArrayBuffer);
    vec3 lower = positions.at(0), upper = positions.at(0);
    for (const vec3& p : positions) {
      lower = glm::min(lower, p);
      upper = glm::max(upper, p);
    }
    document_["accessors"][accessor]["min"] = {lower.x, lower.y, lower.z};
    document_["accessors"][accessor]["max"] = {upper.x, upper.y, upper.z};
    return accessor;
  }

  std::size_t addSampler(const Texture& texture) {
    constexpr int kWrap[] = {10497, 33648, 33071};  // in the order of Wrap
    const int nearest = 9728, linear = 9729, mipmap = 256, linearMipmap = 258;
    int minify = texture.minifyNearest ? nearest : linear;
    if (texture.useMipmaps) minify += texture.minifyNearest ? mipmap : linearMipmap;
    const Json sampler = {{"magFilter", texture.magnifyNearest ? nearest : linear},
                          {"minFilter", minify},
                          {"wrapS", kWrap[std::size_t(texture.wrapU)]},
                          {"wrapT", kWrap[std::size_t(texture.wrapV)]}};
    Json& samplers = document_["samplers"];
    for (std::size_t i = 0; i < samplers.size(); ++i)
      if (samplers[i] == sampler) return i;
    samplers.push_back(sampler);
    return samplers.size() - 1;
  }

  void addTexture(const Texture& texture, const EncodedImage& encoded) {
    Json image = {{"bufferView", addView(encoded.bytes, 0)},
                  {"mimeType", encoded.isJpeg ? "image/jpeg" : "image/png"}};
    if (!texture.name.empty()) image["name"] = texture.name;
    document_["images"].push_back(image);
    document_["textures"].push_back(
        {{"source", document_["images"].size() - 1}, {"sampler", addSampler(texture)}});
  }

  Json primitiveJson(const MeshPrimitive& primitive) {
    assert(!primitive.positions.empty() && !primitive.indices.empty());
    Json json;
    Json& attributes = json["attributes"];
    const auto addAttribute = [&](const char* name, const auto& values, const char* type) {
      if (values.empty()) return;
      assert(values.size() == primitive.positions.size());
      attributes[name] = addAccessor(values, type, kFloat, kArrayBuffer);
    };
    attributes["POSITION"] = addPositions(primitive.positions);
    addAttribute("NORMAL", primitive.normals, "VEC3");
    addAttribute("TANGENT", primitive.tangents, "VEC4");
    addAttribute("TEXCOORD_0", primitive.uv[0], "VEC2");
    addAttribute("TEXCOORD_1", primitive.uv[1], "VEC2");
    addAttribute("COLOR_0", primitive.colors, "VEC4");
    json["indices"] = addAccessor(primitive.indices, "SCALAR", kUnsignedInt, kElementArrayBuffer);
    if (primitive.material >= 0) json["material"] = primitive.material;
    return json;
  }

  void addMesh(const Mesh& mesh) {
    Json json;
    if (!mesh.name.empty()) json["name"] = mesh.name;
    for (const MeshPrimitive& primitive : mesh.primitives)
      json["primitives"].push_back(primitiveJson(primitive));
    document_["meshes"].push_back(json);
  }

  void addNode(Json node, const dmat4& worldFromNode) {
    if (worldFromNode != dmat4(1.0)) {
      Json matrix = Json::array();
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
          const float value = float(worldFromNode[column][row]);
          matrix.push_back(makeNumber(value == 0.0f ? 0.0f : value));  // no "-0.0"
        }
      node["matrix"] = matrix;
    }
    document_["nodes"].push_back(node);
  }

  void addInstance(const Instance& instance) {
    Json node = {{"mesh", instance.mesh}};
    if (!instance.name.empty()) node["name"] = instance.name;
    const Json hint = makeHintJson(instance.hint);
    if (!hint.is_null()) node["extras"]["catoptric"] = hint;
    if (instance.node < 0) {
      addNode(std::move(node), instance.worldFromMesh);
      return;
    }
    assert(instance.nodeFromMesh == dmat4(1.0));
    addMovingNode(std::move(node), instance.node);
  }

  /// In the pose of a node of the motion, which animations may move.
  void addMovingNode(Json node, int motionNode) {
    const MotionNode& moving = scene_.motion.nodes.at(std::size_t(motionNode));
    assert(moving.parent < 0 && !moving.hasMatrix);
    nodeOf_[motionNode] = document_["nodes"].size();
    node["translation"] = makeVectorJson(vec3(moving.translation));
    node["rotation"] = Json::array();
    for (const double value : {moving.rotation.x, moving.rotation.y, moving.rotation.z, moving.rotation.w})
      node["rotation"].push_back(makeNumber(float(value)));
    node["scale"] = makeVectorJson(vec3(moving.scale));
    document_["nodes"].push_back(node);
  }

  void addLight(const Light& light) {
    constexpr const char* kTypes[] = {"directional", "point", "spot"};  // in the order of LightType
    const float intensity = std::max({light.color.x, light.color.y, light.color.z, 1e-6f});
    Json json = {{"type", kTypes[std::size_t(light.type)]},
                 {"color", makeVectorJson(light.color / intensity)},
                 {"intensity", makeNumber(intensity)}};
    if (light.range > 0 && light.type != LightType::Directional) json["range"] = makeNumber(light.range);
    if (light.type == LightType::Spot)
      json["spot"] = {{"innerConeAngle", makeNumber(light.innerConeRadians)},
                      {"outerConeAngle", makeNumber(light.outerConeRadians)}};
    used_.insert("KHR_lights_punctual");
    Json& lights = document_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(json);
    const std::string name = "light " + std::to_string(lights.size() - 1);
    const Json node = {{"name", name},
                       {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}};
    const dvec3 direction = glm::normalize(dvec3(light.direction));
    const dvec3 up = std::abs(direction.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 position = light.type == LightType::Directional ? dvec3(0) : dvec3(light.position);
    addNode(node, glm::inverse(glm::lookAt(position, position + direction, up)));
  }

  void addCamera(const Camera& camera) {
    document_["cameras"].push_back(
        {{"type", "perspective"},
         {"name", camera.name},
         {"perspective", {{"yfov", makeNumber(float(camera.fovYRadians))}, {"znear", 0.01}}}});
    Json node = {{"name", camera.name}, {"camera", document_["cameras"].size() - 1}};
    if (camera.node < 0)
      return addNode(std::move(node), glm::inverse(glm::lookAt(camera.eye, camera.target, camera.up)));
    addMovingNode(std::move(node), camera.node);
  }

  std::size_t addTimes(const std::vector<float>& timesS) {
    const std::size_t accessor = addAccessor(timesS, "SCALAR", kFloat, 0);
    document_["accessors"][accessor]["min"] = {timesS.front()};
    document_["accessors"][accessor]["max"] = {timesS.back()};
    return accessor;
  }

  void addAnimation(const Animation& animation) {
    constexpr const char* kPaths[] = {"translation", "rotation", "scale", "weights"};
    constexpr const char* kInterpolations[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    Json json = {{"name", animation.name}};
    for (const AnimationChannel& channel : animation.channels) {
      const std::size_t times = addTimes(channel.timesS);
      const std::size_t values = addAccessor(channel.values, "SCALAR", kFloat, 0);
      if (channel.property != AnimatedProperty::Weights) {
        document_["accessors"][values]["type"] = channel.width == 4 ? "VEC4" : "VEC3";
        document_["accessors"][values]["count"] = channel.values.size() / channel.width;
      }
      json["samplers"].push_back({{"input", times},
                                  {"output", values},
                                  {"interpolation", kInterpolations[std::size_t(channel.interpolation)]}});
      json["channels"].push_back(
          {{"sampler", json["samplers"].size() - 1},
           {"target",
            {{"node", nodeOf_.at(channel.node)}, {"path", kPaths[std::size_t(channel.property)]}}}});
    }
    document_["animations"].push_back(json);
  }

  void finishScene() {
    Json root = Json::object();
    if (!scene_.name.empty()) root["name"] = scene_.name;
    const std::size_t nodeCount = document_.contains("nodes") ? document_["nodes"].size() : 0;
    for (std::size_t i = 0; i < nodeCount; ++i) root["nodes"].push_back(i);
    document_["scenes"] = Json::array({root});
    document_["scene"] = 0;
    for (const std::string& name : used_) document_["extensionsUsed"].push_back(name);
    binary_.resize((binary_.size() + 3) / 4 * 4);
    if (!binary_.empty()) document_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  }

  std::vector<std::byte> assemble() const {
    std::string text = document_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
    std::vector<std::byte> file;
    file.reserve(total);
    const auto addWord = [&](std::uint32_t word) {  // little-endian on every machine
      for (int shift = 0; shift < 32; shift += 8) file.push_back(std::byte((word >> shift) & 0xff));
    };
    addWord(0x46546C67);  // "glTF"
    addWord(2);
    addWord(std::uint32_t(total));
    addWord(std::uint32_t(text.size()));
    addWord(0x4E4F534A);  // "JSON"
    const auto textBytes = std::as_bytes(std::span<const char>(text));
    file.insert(file.end(), textBytes.begin(), textBytes.end());
    if (binary_.empty()) return file;
    addWord(std::uint32_t(binary_.size()));
    addWord(0x004E4942);  // "BIN"
    file.insert(file.end(), binary_.begin(), binary_.end());
    return file;
  }

  const Scene& scene_;
  const GlbOptions& options_;
  Json document_;
  std::vector<std::byte> binary_;
  ExtensionNames used_;
  std::map<int, std::size_t> nodeOf_;  ///< by node of the motion
};

}  // namespace

std::vector<std::byte> makeGlb(const Scene& scene, const GlbOptions& options) {
  return GlbBuilder(scene, options).build();
}

}  // namespace catoptric::scene
