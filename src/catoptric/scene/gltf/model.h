// SPDX-License-Identifier: Apache-2.0
// The validated document: plain structs in which every index is in range, every accessor lies inside its
// buffer view, every view inside its buffer, and the nodes are trees. Nothing here has touched a byte of
// geometry. Reading and validating are one step: readModel() takes each member through a checked getter
// (element.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/scene/gltf/container.h"
#include "catoptric/scene/gltf/element.h"
#include "catoptric/scene/material.h"
#include "catoptric/scene/motion.h"

namespace catoptric::scene::gltf {

struct Buffer {
  std::size_t byteLength = 0;
  std::optional<std::string> uri;
};

struct BufferView {
  int buffer = -1;
  std::size_t byteOffset = 0, byteLength = 0;
  std::size_t byteStride = 0;  ///< 0: not given.
};

enum class ComponentType : std::uint16_t {
  Int8 = 5120,
  Uint8 = 5121,
  Int16 = 5122,
  Uint16 = 5123,
  Uint32 = 5125,
  Float = 5126
};
enum class ElementType : std::uint8_t { Scalar, Vec2, Vec3, Vec4, Mat2, Mat3, Mat4 };

[[nodiscard]] std::size_t componentBytes(ComponentType type);
[[nodiscard]] std::size_t componentCount(ElementType type);
/// With the padding that starts each column of a small matrix at a multiple of 4.
[[nodiscard]] std::size_t elementBytes(ElementType element, ComponentType component);

struct SparseValues {
  std::size_t count = 0;
  int indexView = -1, valueView = -1;
  std::size_t indexOffset = 0, valueOffset = 0;
  ComponentType indexType = ComponentType::Uint32;
};

struct Accessor {
  int bufferView = -1;  ///< -1: zeros.
  std::size_t byteOffset = 0;
  ComponentType component = ComponentType::Float;
  ElementType element = ElementType::Scalar;
  bool normalized = false;
  std::size_t count = 0;
  std::optional<SparseValues> sparse;
};

struct Image {
  std::string name;
  std::optional<std::string> uri;
  int bufferView = -1;
};

struct Sampler {
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
  bool magnifyNearest = false, minifyNearest = false, useMipmaps = true;
};

struct TextureSource {
  std::string name;
  int image = -1;    ///< -1: nothing that we can read.
  int sampler = -1;  ///< -1: default.
};

using Attributes = std::vector<std::pair<std::string, int>>;  ///< Semantic and accessor, sorted.

/// The accessor of `semantic`, -1 if absent.
[[nodiscard]] int findAttribute(const Attributes& attributes, std::string_view semantic);

enum class PrimitiveMode : std::uint8_t {
  Points,
  Lines,
  LineLoop,
  LineStrip,
  Triangles,
  TriangleStrip,
  TriangleFan
};

struct Primitive {
  Attributes attributes;
  std::vector<Attributes> targets;
  int indices = -1, material = -1;
  PrimitiveMode mode = PrimitiveMode::Triangles;
};

struct MeshSource {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> weights;
};

struct Node {
  std::string name;
  std::vector<int> children;
  int parent = -1;
  int mesh = -1, skin = -1, camera = -1, light = -1;
  dmat4 parentFromNode{1.0};
  dvec3 translation{0}, scale{1};  ///< What parentFromNode is made of, unless given as a matrix.
  glm::dquat rotation{1, 0, 0, 0};
  bool hasMatrix = false;  ///< Given as a matrix, which must not be animated.
  std::vector<float> weights;
  Attributes instancing;  ///< EXT_mesh_gpu_instancing: TRANSLATION, ROTATION, SCALE.
  ReflectorHint hint;
};

struct ChannelSource {
  int node = -1, input = -1, output = -1;  ///< Input and output are accessors.
  AnimatedProperty property = AnimatedProperty::Translation;
  Interpolation interpolation = Interpolation::Linear;
  std::size_t width = 3;  ///< Floats in a value.
};

struct AnimationSource {
  std::string name;
  std::vector<ChannelSource> channels;  ///< Those that drive something we know.
};

struct Skin {
  std::vector<int> joints;
  int inverseBindMatrices = -1;
};

struct CameraSource {
  std::string name;
  bool orthographic = false;
  double fovYRadians = 0, halfHeight = 0;
};

struct LightSource {
  std::string type;  ///< "directional", "point" or "spot".
  vec3 color{1.0f};  ///< Times intensity.
  float range = 0, innerConeRadians = 0, outerConeRadians = 0;
};

struct SceneSource {
  std::string name;
  std::vector<int> nodes;
};

struct Model {
  std::vector<Buffer> buffers;
  std::vector<BufferView> bufferViews;
  std::vector<Accessor> accessors;
  std::vector<Image> images;
  std::vector<Sampler> samplers;
  std::vector<TextureSource> textures;
  std::vector<Material> materials;  ///< TextureSlot::texture is an index into `textures` above.
  std::vector<MeshSource> meshes;
  std::vector<Skin> skins;
  std::vector<CameraSource> cameras;
  std::vector<LightSource> lights;
  std::vector<Node> nodes;
  std::vector<int> roots;  ///< Nodes without parent, ascending.
  std::vector<SceneSource> scenes;
  std::vector<AnimationSource> animations;  ///< Those with channels.
  int defaultScene = -1;
  bool quantized = false;  ///< KHR_mesh_quantization is declared.
};

/// The whole document. Throws core::Error for whatever breaks the rules; docs/gltf.md lists them.
[[nodiscard]] Model readModel(Context& context, const Element& root, const Container& container);

// The parts of readModel(), in the order in which it calls them; each may rely on the ones before.
void readAssetAndExtensions(Context& context, const Element& root, Model& model);
void readBuffers(Context& context, const Element& root, Model& model, const Container& container);
void readAccessors(Context& context, const Element& root, Model& model);
void readTextures(Context& context, const Element& root, Model& model);
void readMaterials(Context& context, const Element& root, Model& model);
void readMeshes(Context& context, const Element& root, Model& model);
void readCamerasAndLights(Context& context, const Element& root, Model& model);
void readNodes(Context& context, const Element& root, Model& model);
void readSkins(Context& context, const Element& root, Model& model);
void readScenes(Context& context, const Element& root, Model& model);
void readAnimations(Context& context, const Element& root, Model& model);

/// extras.catoptric of a node or material.
[[nodiscard]] ReflectorHint readReflectorHint(Context& context, const Element& owner);

}  // namespace catoptric::scene::gltf
