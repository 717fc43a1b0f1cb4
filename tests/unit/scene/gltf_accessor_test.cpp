// SPDX-License-Identifier: Apache-2.0
// Accessors: every rule of their layout, and a property test that encodes random values in random layouts.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>

#include "catoptric/scene/gltf/data.h"
#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

/// Reads one accessor through the importer's own layers.
std::vector<float> readFloats(const Document& document, int accessor) {
  gltf::Context context("test.gltf", {});
  const Json json = Json::parse(document.text());
  const gltf::Model model = gltf::readModel(context, gltf::Element(context, json), {});
  return gltf::Data(context, model, {}, {}).readFloats(accessor);
}

TEST(GltfAccessor, NormalisesEveryComponentType) {
  Document document;
  const int i8 = document.addAccessor<std::int8_t>({-128, -127, 0, 127}, "SCALAR", 5120);
  const int u8 = document.addAccessor<std::uint8_t>({0, 51, 255, 1}, "SCALAR", 5121);
  const int i16 = document.addAccessor<std::int16_t>({-32768, -32767, 0, 32767}, "SCALAR", 5122);
  const int u16 = document.addAccessor<std::uint16_t>({0, 13107, 65535, 1}, "SCALAR", 5123);
  const int u32 = document.addAccessor<std::uint32_t>({0, 1, 4000000000u}, "SCALAR", 5125);
  EXPECT_EQ(readFloats(document, i8), (std::vector<float>{-128, -127, 0, 127}));
  EXPECT_EQ(readFloats(document, u32), (std::vector<float>{0, 1, 4e9f}));
  for (const int index : {i8, u8, i16, u16})
    document.json["accessors"][std::size_t(index)]["normalized"] = true;
  EXPECT_EQ(readFloats(document, i8), (std::vector<float>{-1, -1, 0, 1}));
  EXPECT_EQ(readFloats(document, u8), (std::vector<float>{0, 0.2f, 1, 1 / 255.0f}));
  EXPECT_EQ(readFloats(document, i16), (std::vector<float>{-1, -1, 0, 1}));
  EXPECT_EQ(readFloats(document, u16), (std::vector<float>{0, 0.2f, 1, 1 / 65535.0f}));
  document.json["accessors"][std::size_t(u32)]["normalized"] = true;
  EXPECT_REFUSED(document, "gltf.accessor_format", "/accessors/4/normalized");
}

TEST(GltfAccessor, ColumnsOfSmallMatricesStartAtMultiplesOfFour) {
  Document document;
  document.addView<std::uint8_t>({1, 2, 99, 99, 3, 4, 99, 99});
  document.addView<std::uint8_t>({1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99});
  document.json["accessors"] = {{{"bufferView", 0}, {"componentType", 5121}, {"type", "MAT2"}, {"count", 1}},
                                {{"bufferView", 1}, {"componentType", 5121}, {"type", "MAT3"}, {"count", 1}}};
  EXPECT_EQ(readFloats(document, 0), (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(readFloats(document, 1), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(GltfAccessor, SparseReplacesElementsOfABaseOrOfZeros) {
  Document document;
  const int base = document.addFloats({1, 1, 2, 2, 3, 3}, "VEC2");
  const int indices = document.addView<std::uint8_t>({0, 2}), values = document.addView<float>({7, 8, 9, 10});
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                       {"values", {{"bufferView", values}}}};
  document.json["accessors"][std::size_t(base)]["sparse"] = sparse;
  EXPECT_EQ(readFloats(document, base), (std::vector<float>{7, 8, 2, 2, 9, 10}));
  document.json["accessors"][std::size_t(base)].erase("bufferView");
  EXPECT_EQ(readFloats(document, base), (std::vector<float>{7, 8, 0, 0, 9, 10}));
}

TEST(GltfAccessor, SparseAbuseIsRefused) {
  const auto withSparse = [](const std::vector<std::uint8_t>& indices, std::size_t count,
                             const Json& change) {
    Document document;
    const int base = document.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    document.addPrimitive({{"POSITION", base}});
    const int indexView = document.addView(indices),
              valueView = document.addView(std::vector<float>(3 * indices.size(), 1.0f));
    Json sparse = {{"count", count},
                   {"indices", {{"bufferView", indexView}, {"componentType", 5121}}},
                   {"values", {{"bufferView", valueView}}}};
    sparse.merge_patch(change);
    document.json["accessors"][0]["sparse"] = sparse;
    return document;
  };
  EXPECT_REFUSED(withSparse({0, 3}, 2, Json::object()), "gltf.index_out_of_range",
                 "/accessors/0/sparse/indices");
  EXPECT_REFUSED(withSparse({1, 1}, 2, Json::object()), "gltf.accessor_data", "/accessors/0/sparse/indices");
  EXPECT_REFUSED(withSparse({2, 1}, 2, Json::object()), "gltf.accessor_data", "/accessors/0/sparse/indices");
  EXPECT_REFUSED(withSparse({0, 1}, 4, Json::object()), "gltf.value", "/accessors/0/sparse/count");
  EXPECT_REFUSED(withSparse({0, 1}, 0, Json::object()), "gltf.value", "/accessors/0/sparse/count");
  EXPECT_REFUSED(withSparse({0, 1}, 3, Json::object()), "gltf.accessor_range", "/accessors/0/sparse/indices");
  EXPECT_REFUSED(withSparse({0, 1}, 2, {{"indices", {{"byteOffset", 1}}}}), "gltf.accessor_range",
                 "/accessors/0/sparse/indices");
  EXPECT_REFUSED(withSparse({0, 1}, 2, {{"values", {{"byteOffset", 2}}}}), "gltf.accessor_alignment",
                 "/accessors/0/sparse/values");
  EXPECT_REFUSED(withSparse({0, 1}, 2, {{"indices", {{"componentType", 5126}}}}), "gltf.accessor_format",
                 "/accessors/0/sparse/indices/componentType");
}

/// The triangle with `key` of an accessor or buffer view replaced.
Document with(const char* list, const char* key, const Json& value) {
  Document document = makeTriangle();
  document.json[list][0][key] = value;
  return document;
}

TEST(GltfAccessor, RangesCannotWrap) {
  EXPECT_REFUSED(with("accessors", "count", 4), "gltf.accessor_range", "/accessors/0");
  EXPECT_REFUSED(with("accessors", "count", 1ull << 53), "gltf.accessor_range", "/accessors/0");
  EXPECT_REFUSED(with("accessors", "count", 6148914691236517206ull), "gltf.value",
                 "/accessors/0/count");  // * 12 wraps to 8
  EXPECT_REFUSED(with("accessors", "count", 0), "gltf.value", "/accessors/0/count");
  EXPECT_REFUSED(with("accessors", "byteOffset", 4), "gltf.accessor_range", "/accessors/0");
  EXPECT_REFUSED(with("accessors", "byteOffset", (1ull << 53) - 4), "gltf.accessor_range", "/accessors/0");
  EXPECT_REFUSED(with("bufferViews", "byteOffset", 1ull << 53), "gltf.accessor_range", "/bufferViews/0");
  EXPECT_REFUSED(with("bufferViews", "byteLength", 73), "gltf.accessor_range", "/bufferViews/0");
  EXPECT_REFUSED(with("bufferViews", "byteLength", 0), "gltf.value", "/bufferViews/0/byteLength");
  EXPECT_REFUSED(with("bufferViews", "buffer", 1), "gltf.index_out_of_range", "/bufferViews/0/buffer");
}

TEST(GltfAccessor, StridesAndAlignment) {
  EXPECT_REFUSED(with("bufferViews", "byteStride", 8), "gltf.accessor_stride", "/accessors/0");
  EXPECT_REFUSED(with("bufferViews", "byteStride", 13), "gltf.accessor_stride", "/bufferViews/0/byteStride");
  EXPECT_REFUSED(with("bufferViews", "byteStride", 256), "gltf.value", "/bufferViews/0/byteStride");
  EXPECT_REFUSED(with("bufferViews", "byteStride", 0), "gltf.value", "/bufferViews/0/byteStride");
  EXPECT_REFUSED(with("bufferViews", "byteStride", 40), "gltf.accessor_stride", "/bufferViews/0");
  EXPECT_REFUSED(with("bufferViews", "byteOffset", 2), "gltf.accessor_alignment", "/accessors/0");
  EXPECT_EQ(checkScene(import(with("bufferViews", "byteStride", 12))), "");
}

TEST(GltfAccessor, TypesMustBeKnown) {
  EXPECT_REFUSED(with("accessors", "componentType", 5124), "gltf.value", "/accessors/0/componentType");
  EXPECT_REFUSED(with("accessors", "componentType", 5130), "gltf.value", "/accessors/0/componentType");
  EXPECT_REFUSED(with("accessors", "type", "VEC5"), "gltf.value", "/accessors/0/type");
  EXPECT_REFUSED(with("accessors", "min", Json::array({0})), "gltf.value", "/accessors/0/min");
  Document document = makeTriangle();
  document.json["accessors"][0].erase("bufferView");
  document.json["accessors"][0]["byteOffset"] = 0;
  EXPECT_REFUSED(document, "gltf.missing", "/accessors/0/byteOffset");
}

/// Encodes and decodes `count` elements of `components` values of type T with the given stride and offset.
template <class T>
void checkRoundTrip(int componentType, std::size_t components, std::size_t count, std::size_t gap,
                    std::size_t offset, bool normalized, unsigned seed) {
  static const char* const kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  const std::size_t bytes = components * sizeof(T), stride = (bytes + 3) / 4 * 4 + 4 * gap,
                    start = offset * sizeof(T);
  std::mt19937 random(seed);
  std::vector<std::uint8_t> data(start + stride * count);
  for (std::uint8_t& byte : data) byte = std::uint8_t(random());
  std::vector<float> expected;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < components; ++c) {
      const T value = std::is_floating_point_v<T> ? T(int(random() % 2000) - 1000) / T(8) : T(random());
      std::memcpy(&data[start + i * stride + c * sizeof(T)], &value, sizeof(T));
      const double scaled =
          normalized ? std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0) : double(value);
      expected.push_back(float(scaled));
    }
  Document document;
  const int view = document.addView(data);
  document.json["bufferViews"][std::size_t(view)]["byteStride"] = stride;
  document.json["accessors"] = {{{"bufferView", view},
                                 {"byteOffset", start},
                                 {"componentType", componentType},
                                 {"type", kTypes[components - 1]},
                                 {"count", count},
                                 {"normalized", normalized}}};
  const std::vector<float> got = readFloats(document, 0);
  RC_ASSERT(got.size() == expected.size());
  for (std::size_t i = 0; i < got.size(); ++i)
    RC_ASSERT(std::abs(got[i] - expected[i]) <= 1e-6f * std::abs(expected[i]));
}

RC_GTEST_PROP(GltfAccessor, DecodesWhatWasEncodedInAnyLayout, ()) {
  const auto components = *rc::gen::inRange<std::size_t>(1, 5), count = *rc::gen::inRange<std::size_t>(1, 20);
  const auto gap = *rc::gen::inRange<std::size_t>(0, 4), offset = *rc::gen::inRange<std::size_t>(0, 9);
  const bool normalized = *rc::gen::arbitrary<bool>();
  const auto seed = *rc::gen::arbitrary<unsigned>();
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return checkRoundTrip<std::int8_t>(5120, components, count, gap, offset, normalized, seed);
    case 1:
      return checkRoundTrip<std::uint8_t>(5121, components, count, gap, offset, normalized, seed);
    case 2:
      return checkRoundTrip<std::int16_t>(5122, components, count, gap, offset, normalized, seed);
    case 3:
      return checkRoundTrip<std::uint16_t>(5123, components, count, gap, offset, normalized, seed);
    case 4:
      return checkRoundTrip<std::uint32_t>(5125, components, count, gap, offset, false, seed);
    default:
      return checkRoundTrip<float>(5126, components, count, gap, offset, false, seed);
  }
}

}  // namespace
}  // namespace catoptric::scene::gltf_test
