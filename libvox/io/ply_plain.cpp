// Positions and faces of binary PLY files, without detours.

#include "libvox/io/ply_plain.h"

#include "libvox/io/byte_order.h"
#include "libvox/io/read_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace vox {

namespace {

// The number type of the positions or corners of an element without colours and texture
// coordinates; nothing: the element is of another kind, or has more.
std::optional<PlyType> plainType(const PlyElement& element) {
  std::optional<PlyType> type;
  int lists = 0;
  for (const PlyProperty& property : element.properties) {
    lists += property.isList ? 1 : 0;
    if (property.role == PlyRole::kIgnored) continue;
    const bool isPosition = property.role >= PlyRole::kX && property.role <= PlyRole::kZ;
    if (!isPosition && property.role != PlyRole::kFace) return std::nullopt;
    if (type && *type != property.type) return std::nullopt;
    type = property.type;
  }
  return lists == (element.isFace ? 1 : 0) ? type : std::nullopt;
}

// The bytes of a face besides its corners.
std::size_t bytesBesidesCorners(const PlyElement& element) {
  std::size_t size = 0;
  for (const PlyProperty& property : element.properties)
    size += sizeOf(property.isList ? property.countType : property.type);
  return size;
}

// Writes the positions of vertices. False: a coordinate is too large.
template <typename Number>
bool loadPoints(const PlainBlock& block, Vec3d* points) {
  std::array<std::size_t, 3> offsets{};
  std::size_t size = 0;
  for (const PlyProperty& property : block.element->properties) {
    if (property.role >= PlyRole::kX && property.role <= PlyRole::kZ)
      offsets.at(static_cast<std::size_t>(property.role) - static_cast<std::size_t>(PlyRole::kX)) =
          size;
    size += sizeOf(property.type);
  }
  bool isSound = true;
  const char* at = block.bytes.data();
  for (std::uint64_t v = 0; v < block.count; ++v, at += size)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(loadNumber<Number>(at + offsets[axis], block.order));
      isSound &= !(std::abs(value) > kMaxCoordinate) || std::isinf(value);
      points[v][static_cast<int>(axis)] = value;
    }
  return isSound;
}

// Writes the corners of faces, and the offsets after each face. False: a face has fewer than 3
// corners, or an index is out of range.
template <typename Number>
bool loadFaces(const PlainBlock& block, std::uint64_t vertexCount, Index corner, Index* vertices,
               Index* offsets) {
  const auto& properties = block.element->properties;
  const auto list = std::find_if(properties.begin(), properties.end(),
                                 [](const PlyProperty& property) { return property.isList; });
  std::size_t before = 0;
  for (auto property = properties.begin(); property != list; ++property)
    before += sizeOf(property->type);
  const std::size_t countSize = sizeOf(list->countType);
  const std::size_t after = bytesBesidesCorners(*block.element) - before - countSize;
  bool isSound = true;
  const char* at = block.bytes.data();
  for (std::uint64_t f = 0; f < block.count; ++f, at += after) {
    at += before;
    const std::int64_t corners = *plyListCount(at, list->countType, block.order);
    isSound &= corners >= 3;
    at += countSize;
    for (std::int64_t i = 0; i < corners; ++i, at += sizeof(Number)) {
      const auto index = static_cast<std::int64_t>(loadNumber<Number>(at, block.order));
      isSound &= index >= 0 && index < static_cast<std::int64_t>(vertexCount);
      *vertices++ = static_cast<Index>(index);
    }
    corner += static_cast<Index>(corners);
    *offsets++ = corner;
  }
  return isSound;
}

}  // namespace

PlyCounts countsOf(const PlainBlock& block) {
  if (block.element->isVertex) return {.points = block.count};
  const std::size_t others = block.count * bytesBesidesCorners(*block.element);
  return {.corners = (block.bytes.size() - others) / sizeOf(block.type), .faces = block.count};
}

bool loadPlain(const PlainBlock& block, std::uint64_t vertexCount, const PlyCounts& start,
               PolygonMesh& mesh) {
  return withType(block.type, [&](auto zero) {
    using Number = decltype(zero);
    if (block.element->isVertex)
      return loadPoints<Number>(block, mesh.points.data() + start.points);
    if constexpr (std::is_integral_v<Number>)
      return loadFaces<Number>(block, vertexCount, static_cast<Index>(start.corners),
                               mesh.faceVertices.data() + start.corners,
                               mesh.faceOffsets.data() + start.faces + 1);
    return false;
  });
}

std::optional<PlainBlock> plainBlockOf(const PlyHeader& header, const PlyBlock& block) {
  std::optional<PlainBlock> plain;
  if (!header.binaryOrder) return plain;
  forEachKind(header, block.first, block.end,
              [&](const PlyElement& element, std::uint64_t from, std::uint64_t to) {
                if (const auto type = plainType(element))
                  plain = PlainBlock{&element, *type, to - from, block.bytes, *header.binaryOrder};
              });
  return plain;
}

}  // namespace vox
