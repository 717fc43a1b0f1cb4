// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/element.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <unordered_set>

namespace catoptric::scene::gltf {
namespace {

/// Key as a part of a JSON pointer (RFC 6901), safe to print.
std::string escapeKey(std::string_view key) {
  std::string out;
  for (const char c : printable(key)) {
    if (c == '~')
      out += "~0";
    else if (c == '/')
      out += "~1";
    else
      out += c;
  }
  return out;
}

}  // namespace

Element::Element(const Context& context, const Json& root) : context_(&context), value_(&root) {
  requireObject();
}

Element::Element(const Element& parent, const Json& value, Step step)
    : context_(parent.context_), value_(&value), steps_(parent.steps_), depth_(parent.depth_) {
  assert(depth_ < kMaxSteps);
  steps_[depth_++] = step;
}

std::string Element::pointer() const {
  std::string out;
  for (std::size_t i = 0; i < depth_; ++i) {
    out += '/';
    out += steps_[i].key.data() != nullptr ? escapeKey(steps_[i].key) : std::to_string(steps_[i].index);
  }
  return out;
}

void Element::fail(std::string_view code, const std::string& message, const std::string& hint) const {
  context_->fail(code, message, pointer(), hint);
}

void Element::failType(std::string_view wanted) const {
  fail("gltf.type", fmt::format("expected {}, found {} {}", wanted,
                                value_->is_array() || value_->is_object() ? "an" : "a", value_->type_name()));
}

std::optional<Element> Element::find(std::string_view key) const {
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return Element(*this, *member, {member.key(), 0});
}

std::optional<Element> Element::findObject(std::string_view key) const {
  std::optional<Element> member = find(key);
  if (member) member->requireObject();
  return member;
}

std::optional<Element> Element::findArray(std::string_view key) const {
  std::optional<Element> member = find(key);
  if (member && !member->value_->is_array()) member->failType("an array");
  return member;
}

Element Element::require(std::string_view key) const {
  std::optional<Element> member = find(key);
  if (!member) fail("gltf.missing", fmt::format("the required member \"{}\" is missing", key));
  return *member;
}

Element Element::getObject(std::string_view key) const {
  Element member = require(key);
  member.requireObject();
  return member;
}

Element Element::getArray(std::string_view key) const {
  Element member = require(key);
  if (!member.value_->is_array()) member.failType("an array");
  if (member.value_->empty()) member.fail("gltf.value", fmt::format("\"{}\" must not be empty", key));
  return member;
}

std::optional<Element> Element::findExtension(std::string_view key) const {
  const std::optional<Element> extensions = findObject("extensions");
  return extensions ? extensions->findObject(key) : std::nullopt;
}

int Element::findIndex(std::string_view key, std::size_t limit, std::string_view what) const {
  const std::optional<Element> member = find(key);
  return member ? member->asIndex(limit, what) : -1;
}

int Element::getIndex(std::string_view key, std::size_t limit, std::string_view what) const {
  return require(key).asIndex(limit, what);
}

std::vector<int> Element::findIndexList(std::string_view key, std::size_t limit,
                                        std::string_view what) const {
  const std::optional<Element> list = findArray(key);
  if (!list) return {};
  std::vector<int> out;
  std::unordered_set<int> seen;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Element entry = (*list)[i];
    out.push_back(entry.asIndex(limit, what));
    if (!seen.insert(out.back()).second)
      entry.fail("gltf.duplicate", fmt::format("{} {} is listed twice", what, out.back()));
  }
  return out;
}

std::size_t Element::findInteger(std::string_view key, std::size_t fallback, std::size_t least,
                                 std::size_t most) const {
  const std::optional<Element> member = find(key);
  return member ? member->asInteger(least, most) : fallback;
}

std::size_t Element::getInteger(std::string_view key, std::size_t least, std::size_t most) const {
  return require(key).asInteger(least, most);
}

double Element::findNumber(std::string_view key, double fallback, double least, double most) const {
  const std::optional<Element> member = find(key);
  return member ? member->asNumber(least, most) : fallback;
}

double Element::getNumber(std::string_view key, double least, double most) const {
  return require(key).asNumber(least, most);
}

bool Element::findBool(std::string_view key, bool fallback) const {
  const std::optional<Element> member = find(key);
  return member ? member->asBool() : fallback;
}

std::string Element::findString(std::string_view key, std::string_view fallback) const {
  const std::optional<Element> member = find(key);
  return member ? member->asString() : std::string(fallback);
}

std::string Element::getString(std::string_view key) const {
  return require(key).asString();
}

std::vector<float> Element::findNumberList(std::string_view key) const {
  const std::optional<Element> list = findArray(key);
  if (!list) return {};
  std::vector<float> out;
  for (std::size_t i = 0; i < list->size(); ++i) out.push_back(float((*list)[i].asNumber()));
  return out;
}

Element Element::operator[](std::size_t index) const {
  return Element(*this, (*value_)[index], {{}, index});
}

void Element::requireSize(std::size_t wanted) const {
  if (size() != wanted)
    fail("gltf.value", fmt::format("expected an array of {} numbers, found {} elements", wanted, size()));
}

void Element::requireObject() const {
  if (!value_->is_object()) failType("an object");
}

std::size_t Element::asInteger(std::size_t least, std::size_t most) const {
  // Exporters in languages without integers write 3 as 3.0; that is a valid JSON integer, 3.5 is not.
  const double number = asNumber(-std::numeric_limits<double>::max(), std::numeric_limits<double>::max());
  if (number != std::floor(number) || number < 0 || number > double(kMaxJsonInteger))
    fail("gltf.value", fmt::format("expected a whole number from 0 up, found {}", number));
  const auto integer = std::size_t(number);
  if (integer < least || integer > most)
    fail("gltf.value", most == kMaxJsonInteger
                           ? fmt::format("{} is too small, the least allowed is {}", integer, least)
                           : fmt::format("{} is outside the allowed range {} to {}", integer, least, most));
  return integer;
}

int Element::asIndex(std::size_t limit, std::string_view what) const {
  const std::size_t index = asInteger();
  if (index >= limit || index > std::size_t(std::numeric_limits<int>::max()))
    fail("gltf.index_out_of_range", fmt::format("there is no {} {}, the file has {}", what, index, limit));
  return int(index);
}

double Element::asNumber(double least, double most) const {
  if (!value_->is_number()) failType("a number");
  const auto number = value_->get<double>();
  if (!(number >= least && number <= most))
    fail("gltf.value", fmt::format("{} is outside the allowed range {} to {}", number, least, most));
  return number;
}

bool Element::asBool() const {
  if (!value_->is_boolean()) failType("true or false");
  return value_->get<bool>();
}

std::string Element::asString() const {
  if (!value_->is_string()) failType("a string");
  return value_->get<std::string>();
}

}  // namespace catoptric::scene::gltf
