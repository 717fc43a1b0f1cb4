// SPDX-License-Identifier: Apache-2.0
// Meshes: the format of every attribute (glTF 2.0 section 3.7.2.1, KHR_mesh_quantization), equal counts,
// targets.
#include <fmt/format.h>

#include <algorithm>

#include "catoptric/scene/gltf/model.h"

namespace catoptric::scene::gltf {
namespace {

/// Component types as bits: plain or normalized.
enum Format : unsigned {
  kFloat = 1,
  kInt8 = 2,
  kInt8n = 4,
  kUint8 = 8,
  kUint8n = 16,
  kInt16 = 32,
  kInt16n = 64,
  kUint16 = 128,
  kUint16n = 256,
  kOther = 512
};
constexpr unsigned kAnySmall = kInt8 | kInt8n | kUint8 | kUint8n | kInt16 | kInt16n | kUint16 | kUint16n;

unsigned formatOf(const Accessor& accessor) {
  switch (accessor.component) {
    case ComponentType::Float:
      return kFloat;
    case ComponentType::Int8:
      return accessor.normalized ? kInt8n : kInt8;
    case ComponentType::Uint8:
      return accessor.normalized ? kUint8n : kUint8;
    case ComponentType::Int16:
      return accessor.normalized ? kInt16n : kInt16;
    case ComponentType::Uint16:
      return accessor.normalized ? kUint16n : kUint16;
    default:
      return kOther;
  }
}

struct Rule {
  std::string_view semantic;  ///< Without the number of its set.
  bool hasSets;
  unsigned elements;   ///< Bit per ElementType.
  unsigned core;       ///< Formats of glTF 2.0.
  unsigned quantized;  ///< Further formats of KHR_mesh_quantization.
};

constexpr unsigned bit(ElementType type) {
  return 1u << unsigned(type);
}

constexpr std::array kAttributeRules = {
    Rule{"POSITION", false, bit(ElementType::Vec3), kFloat, kAnySmall},
    Rule{"NORMAL", false, bit(ElementType::Vec3), kFloat, kInt8n | kInt16n},
    Rule{"TANGENT", false, bit(ElementType::Vec4), kFloat, kInt8n | kInt16n},
    Rule{"TEXCOORD", true, bit(ElementType::Vec2), kFloat | kUint8n | kUint16n, kAnySmall},
    Rule{"COLOR", true, bit(ElementType::Vec3) | bit(ElementType::Vec4), kFloat | kUint8n | kUint16n, 0},
    Rule{"JOINTS", true, bit(ElementType::Vec4), kUint8 | kUint16, 0},
    Rule{"WEIGHTS", true, bit(ElementType::Vec4), kFloat | kUint8n | kUint16n, 0},
};
constexpr std::array kTargetRules = {
    Rule{"POSITION", false, bit(ElementType::Vec3), kFloat, kInt8 | kInt8n | kInt16 | kInt16n},
    Rule{"NORMAL", false, bit(ElementType::Vec3), kFloat, kInt8n | kInt16n},
    Rule{"TANGENT", false, bit(ElementType::Vec3), kFloat, kInt8n | kInt16n},
    Rule{"TEXCOORD", true, bit(ElementType::Vec2), kFloat | kInt8n | kUint8n | kInt16n | kUint16n, kAnySmall},
    Rule{"COLOR", true, bit(ElementType::Vec3) | bit(ElementType::Vec4),
         kFloat | kInt8n | kUint8n | kInt16n | kUint16n, 0},
};

/// "TEXCOORD_1" matches the rule "TEXCOORD"; "TEXCOORD_01" and "TEXCOORD" do not.
bool matches(const Rule& rule, std::string_view name) {
  if (!rule.hasSets) return name == rule.semantic;
  if (!name.starts_with(rule.semantic) || name.size() < rule.semantic.size() + 2 ||
      name[rule.semantic.size()] != '_')
    return false;
  const std::string_view digits = name.substr(rule.semantic.size() + 1);
  return digits.find_first_not_of("0123456789") == std::string_view::npos &&
         (digits.size() == 1 || digits[0] != '0');
}

void checkFormat(const Element& where, const Accessor& accessor, const Rule& rule, bool quantized) {
  const bool elementFits = (rule.elements & (1u << unsigned(accessor.element))) != 0;
  const unsigned format = formatOf(accessor);
  if (!elementFits || (format & (rule.core | rule.quantized)) == 0)
    where.fail("gltf.accessor_format",
               fmt::format("the accessor's type does not suit the attribute {}", rule.semantic));
  if ((format & rule.core) == 0 && !quantized)
    where.fail("gltf.accessor_format", fmt::format("the accessor's type suits the attribute {} only with "
                                                   "KHR_mesh_quantization, which is not declared",
                                                   rule.semantic));
}

/// Vertex data that is not aligned to 4 bytes is against the rules but reads without doubt.
void countUnaligned(Context& context, const Model& model, const Accessor& accessor) {
  if (accessor.bufferView < 0) return;
  const BufferView& view = model.bufferViews[std::size_t(accessor.bufferView)];
  const std::size_t stride =
      view.byteStride != 0 ? view.byteStride : elementBytes(accessor.element, accessor.component);
  if (stride % 4 != 0 || (accessor.byteOffset + view.byteOffset) % 4 != 0)
    context.count(Repair::UnalignedAttribute);
}

template <std::size_t N>
Attributes readAttributes(Context& context, const Element& element, const Model& model,
                          const std::array<Rule, N>& rules) {
  element.requireObject();
  Attributes out;
  for (const auto& [key, value] : element.json().items()) {
    const int index = element.getIndex(key, model.accessors.size(), "accessor");
    const Element where = *element.find(key);
    const Accessor& accessor = model.accessors[std::size_t(index)];
    const auto rule =
        std::find_if(rules.begin(), rules.end(), [&k = key](const Rule& r) { return matches(r, k); });
    if (accessor.component == ComponentType::Uint32)
      where.fail("gltf.accessor_format", "a vertex attribute must not have 32 bit integers");
    if (rule == rules.end()) {
      if (!key.starts_with('_'))
        context.warn(fmt::format("the vertex attribute \"{}\" is unknown and was ignored", printable(key)));
      continue;
    }
    checkFormat(where, accessor, *rule, model.quantized);
    countUnaligned(context, model, accessor);
    out.emplace_back(key, index);
  }
  return out;
}

void checkCounts(const Element& element, const Model& model, const Attributes& attributes,
                 std::size_t count) {
  for (const auto& [name, accessor] : attributes)
    if (model.accessors[std::size_t(accessor)].count != count)
      element.find(name)->fail("gltf.accessor_format",
                               fmt::format("{} has {} elements, the primitive has {} vertices", name,
                                           model.accessors[std::size_t(accessor)].count, count));
}

void readIndices(const Element& element, const Model& model, Primitive& primitive) {
  primitive.indices = element.findIndex("indices", model.accessors.size(), "accessor");
  if (primitive.indices < 0) return;
  const Accessor& accessor = model.accessors[std::size_t(primitive.indices)];
  const bool isUnsigned = accessor.component == ComponentType::Uint8 ||
                          accessor.component == ComponentType::Uint16 ||
                          accessor.component == ComponentType::Uint32;
  if (accessor.element != ElementType::Scalar || !isUnsigned || accessor.normalized)
    element.find("indices")->fail("gltf.accessor_format",
                                  "indices must be plain unsigned integers, one each");
  if (accessor.bufferView < 0) return;
  const std::size_t stride = model.bufferViews[std::size_t(accessor.bufferView)].byteStride;
  if (stride != 0 && stride != componentBytes(accessor.component))
    element.find("indices")->fail("gltf.accessor_stride",
                                  "indices must not lie in a buffer view with a stride");
}

void readTargets(Context& context, const Element& element, const Model& model, Primitive& primitive,
                 std::size_t count) {
  const std::optional<Element> targets = element.findArray("targets");
  for (std::size_t i = 0; targets && i < targets->size(); ++i) {
    const Element target = (*targets)[i];
    Attributes attributes = readAttributes(context, target, model, kTargetRules);
    checkCounts(target, model, attributes, count);
    std::erase_if(attributes, [&](const auto& entry) {
      const bool isOrphan = findAttribute(primitive.attributes, entry.first) < 0;
      if (isOrphan) context.warn("a morph target has an attribute that its primitive lacks; it was ignored");
      return isOrphan;
    });
    primitive.targets.push_back(std::move(attributes));
  }
}

Primitive readPrimitive(Context& context, const Element& element, const Model& model) {
  Primitive primitive;
  const Element attributes = element.getObject("attributes");
  primitive.attributes = readAttributes(context, attributes, model, kAttributeRules);
  primitive.material = element.findIndex("material", model.materials.size(), "material");
  primitive.mode = PrimitiveMode(element.findInteger("mode", 4, 0, 6));
  readIndices(element, model, primitive);
  const int position = findAttribute(primitive.attributes, "POSITION");
  if (!primitive.attributes.empty()) {
    const int first = position >= 0 ? position : primitive.attributes.front().second;
    const std::size_t count = model.accessors[std::size_t(first)].count;
    if (count > 0x7FFFFFFFu)
      attributes.fail("gltf.value", "a primitive must not have more than 2^31 vertices");
    checkCounts(attributes, model, primitive.attributes, count);
    readTargets(context, element, model, primitive, count);
  }
  std::size_t joints = 0, weights = 0;
  for (const auto& entry : primitive.attributes) {
    joints += entry.first.starts_with("JOINTS_") ? 1 : 0;
    weights += entry.first.starts_with("WEIGHTS_") ? 1 : 0;
  }
  if (joints != weights)
    attributes.fail("gltf.value",
                    fmt::format("the primitive has {} sets of joints but {} of weights", joints, weights));
  return primitive;
}

void warnMissingTexCoords(Context& context, const Model& model, const Primitive& primitive) {
  if (primitive.material < 0) return;
  const Material& material = model.materials[std::size_t(primitive.material)];
  for (const TextureSlot* slot :
       {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
        &material.occlusionTexture, &material.emissiveTexture})
    if (slot->texture >= 0 &&
        findAttribute(primitive.attributes, fmt::format("TEXCOORD_{}", slot->uvSet)) < 0)
      context.warn(
          fmt::format("the material \"{}\" has a texture but a mesh that uses it has no TEXCOORD_{}; the "
                      "texture shows one texel there",
                      printable(material.name), slot->uvSet));
}

}  // namespace

void readMeshes(Context& context, const Element& root, Model& model) {
  forEachObject(root, "meshes", [&](const Element& element, std::size_t) {
    MeshSource mesh;
    mesh.name = element.findString("name");
    mesh.weights = element.findNumberList("weights");
    const Element primitives = element.getArray("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const Element primitive = primitives[i];
      primitive.requireObject();
      mesh.primitives.push_back(readPrimitive(context, primitive, model));
      warnMissingTexCoords(context, model, mesh.primitives.back());
      if (mesh.primitives.back().targets.size() != mesh.primitives.front().targets.size())
        primitive.fail("gltf.value", "all primitives of a mesh must have the same number of morph targets");
    }
    if (!mesh.weights.empty() && mesh.weights.size() != mesh.primitives.front().targets.size())
      element.find("weights")->fail("gltf.value",
                                    fmt::format("{} weights for {} morph targets", mesh.weights.size(),
                                                mesh.primitives.front().targets.size()));
    model.meshes.push_back(std::move(mesh));
  });
}

}  // namespace catoptric::scene::gltf
