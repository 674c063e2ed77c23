// Binary STL: conversion and welding of facets, in parallel.
//
// Source: 3D Systems, "StereoLithography Interface Specification", 1989. Colours in the attribute
// of a facet, 5 bits each, as two programs write them:
//   Magics: the header has COLOR=rgba, the colour of the whole; a facet has its own if bit 15 is 0,
//           red in the lowest bits
//   VisCAM, SolidView: a facet has a colour if bit 15 is 1, blue in the lowest bits

#include "libvox/io/binary_stl.h"

#include "libvox/core/buckets.h"
#include "libvox/core/parallel.h"
#include "libvox/io/byte_order.h"
#include "libvox/io/file_colors.h"
#include "libvox/io/point_welder.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

namespace vox {

namespace {

// The colours of the facets of a binary file.
class FacetColors {
 public:
  explicit FacetColors(std::string_view header) {
    constexpr std::string_view kKey = "COLOR=";
    const std::size_t key = header.find(kKey);
    if (key == header.npos || key + kKey.size() + 3 > header.size()) return;
    isMagics_ = true;
    for (std::size_t i = 0; i < 3; ++i)
      whole_[static_cast<int>(i)] =
          static_cast<double>(static_cast<unsigned char>(header[key + kKey.size() + i])) / 255;
  }

  void set(Index face, std::uint16_t attribute) {
    const bool high = (attribute & 0x8000U) != 0;
    const Vec3d fromLowest(attribute & 31U, attribute >> 5U & 31U, attribute >> 10U & 31U);
    if (isMagics_) {
      colors_.set(face, high ? whole_ : Vec3d(fromLowest / 31));
    } else if (high) {
      colors_.set(face, fromLowest.reverse() / 31);
    }
  }

  // Adds the colours of later facets; `firstFace` is the number of their first face.
  void append(const FacetColors& part, Index firstFace) { colors_.append(part.colors_, firstFace); }

  std::vector<Vec3f> take(Index faceCount, ReadReport& report) {
    if (!colors_.empty()) report.add(Oddity::kForeignColor, 0);
    return colors_.takeLinear(faceCount, report);
  }

 private:
  bool isMagics_ = false;
  Vec3d whole_ = Vec3d::Ones();
  FileColors colors_;
};

// Consecutive facets of a binary file, welded among themselves.
struct FacetBlock {
  explicit FacetBlock(std::string_view header) : colors(header) {}

  std::vector<Vec3f> points;  // in order of appearance
  Index faceCount = 0;
  FacetColors colors;
  ReadReport report;
};

// Reads facets [begin, end). Writes three corners for each: numbers of points of the block.
void readFacets(std::string_view data, std::uint64_t begin, std::uint64_t end, Index* corners,
                FacetBlock& block) {
  PointWelder<float> welder(block.points, end - begin);
  for (std::uint64_t f = begin; f < end; ++f) {
    const char* at = data.data() + kStlHeaderBytes + kFacetBytes * f + 12;  // skips the normal
    std::array<Vec3f, 3> positions;
    bool isFinite = true;  // nan, unequal to itself, could not be welded
    for (Vec3f& position : positions) {
      for (int axis = 0; axis < 3; ++axis, at += 4)
        position[axis] = loadNumber<float>(at, std::endian::little);
      isFinite = isFinite && position.allFinite();
    }
    if (!isFinite) {
      block.report.add(Oddity::kUndefinedFacet, 0, f);
      continue;
    }
    block.colors.set(block.faceCount++, loadNumber<std::uint16_t>(at, std::endian::little));
    for (const Vec3f& position : positions) *corners++ = welder.indexOf(position);
  }
}

// A point of a block, and its number among the points of all blocks.
struct NumberedPoint {
  Vec3f position;
  Index number;
};

// Points by their hash: so each bucket can be welded by itself.
Buckets<NumberedPoint> deal(const std::vector<FacetBlock>& blocks,
                            const std::vector<std::size_t>& numbers) {
  constexpr unsigned kBucketBits = 7;
  const auto dealBlock = [&](Index b, auto&& put) {
    auto number = static_cast<Index>(numbers[b]);
    for (const Vec3f& position : blocks[b].points)
      put(static_cast<Index>(PointWelder<float>::hash(position) >> (64 - kBucketBits)),
          NumberedPoint{position, number++});
  };
  return {static_cast<Index>(blocks.size()), Index{1} << kBucketBits, dealBlock, 1};
}

// For each point of all blocks, the first one that is equal.
std::vector<Index> firstEquals(const Buckets<NumberedPoint>& dealt, std::size_t count) {
  std::vector<Index> firsts(count);
  parallelForEach(dealt.size(), 1, [&](Index bucket) {
    std::vector<Vec3f> points;
    std::vector<Index> numbers;
    PointWelder<float> welder(points, dealt[bucket].size());
    for (const auto& [position, number] : dealt[bucket]) {
      const Index point = welder.indexOf(position);
      if (point == numbers.size()) numbers.push_back(number);
      firsts[number] = numbers[point];
    }
  });
  return firsts;
}

// Welds the blocks together. Points keep the order of their first appearance.
// Precondition: block b has its corners from place 3 * facetsPerBlock * b on.
void joinFacets(const std::vector<FacetBlock>& blocks, std::uint64_t facetsPerBlock,
                PolygonMesh& mesh) {
  std::vector<std::size_t> starts = {0};  // of the points of each block, and the end
  for (const FacetBlock& block : blocks) starts.push_back(starts.back() + block.points.size());
  const std::vector<Index> firsts = firstEquals(deal(blocks, starts), starts.back());

  std::vector<std::size_t> newStarts(blocks.size() + 1);  // of the points not seen before
  parallelForEach(blocks.size(), 1, [&](std::size_t b) {
    for (std::size_t p = starts[b]; p < starts[b + 1]; ++p)
      newStarts[b + 1] += firsts[p] == p ? 1 : 0;
  });
  std::partial_sum(newStarts.begin(), newStarts.end(), newStarts.begin());
  mesh.points.resize(newStarts.back());
  std::vector<Index> numbers(firsts.size());  // in the mesh; only of first ones
  parallelForEach(blocks.size(), 1, [&](std::size_t b) {
    std::size_t next = newStarts[b];
    for (std::size_t p = starts[b]; p < starts[b + 1]; ++p) {
      if (firsts[p] != p) continue;
      numbers[p] = static_cast<Index>(next);
      mesh.points[next++] = blocks[b].points[p - starts[b]].cast<double>();
    }
  });
  parallelForEach(blocks.size(), 1, [&](std::size_t b) {
    const std::span<Index> corners(mesh.faceVertices.data() + 3 * facetsPerBlock * b,
                                   std::size_t{3} * blocks[b].faceCount);
    for (Index& corner : corners) corner = numbers[firsts[starts[b] + corner]];
  });
}

// Closes the gaps that dropped facets left after the corners of blocks.
void closeGaps(const std::vector<FacetBlock>& blocks, std::uint64_t facetsPerBlock,
               PolygonMesh& mesh) {
  auto end = mesh.faceVertices.begin();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto begin =
        mesh.faceVertices.begin() + static_cast<std::ptrdiff_t>(3 * facetsPerBlock * b);
    const auto size = 3 * static_cast<std::ptrdiff_t>(blocks[b].faceCount);
    end = begin == end ? begin + size : std::copy(begin, begin + size, end);
  }
  mesh.faceVertices.erase(end, mesh.faceVertices.end());
}

}  // namespace

std::uint64_t binaryTriangleCount(std::string_view data) {
  return loadNumber<std::uint32_t>(data.data() + kStlHeaderBytes - 4, std::endian::little);
}

// The first word decides nothing: many binary files start with "solid". Of a text, the size would
// be that of more than 500 million facets.
bool isBinaryStl(std::string_view data) {
  if (data.size() < kStlHeaderBytes) return false;
  const std::uint64_t count = binaryTriangleCount(data);
  const std::uint64_t size = kStlHeaderBytes + kFacetBytes * count;
  return data.size() == size || (count > 0 && data.size() > size);
}

PolygonMesh parseBinaryStl(std::string_view data, std::uint64_t facetsPerBlock,
                           ReadReport& report) {
  const std::string_view header = data.substr(0, kStlHeaderBytes - 4);
  const std::uint64_t count = binaryTriangleCount(data);
  PolygonMesh mesh;
  mesh.faceVertices.resize(3 * count);
  std::vector<FacetBlock> blocks((count + facetsPerBlock - 1) / facetsPerBlock, FacetBlock(header));
  parallelForEach(blocks.size(), 1, [&](std::size_t b) {
    const std::uint64_t begin = b * facetsPerBlock;
    readFacets(data, begin, std::min(count, begin + facetsPerBlock),
               mesh.faceVertices.data() + 3 * begin, blocks[b]);
  });
  joinFacets(blocks, facetsPerBlock, mesh);
  closeGaps(blocks, facetsPerBlock, mesh);
  mesh.faceOffsets.resize(mesh.faceVertices.size() / 3 + 1);
  constexpr std::size_t kFacesPerTask = 1 << 15;
  parallelForEach(mesh.faceOffsets.size(), kFacesPerTask,
                  [&](std::size_t f) { mesh.faceOffsets[f] = static_cast<Index>(3 * f); });

  FacetColors colors(header);
  Index faceCount = 0;
  for (const FacetBlock& block : blocks) {
    colors.append(block.colors, faceCount);
    report.append(block.report);
    faceCount += block.faceCount;
  }
  mesh.faceColors = colors.take(mesh.faceCount(), report);
  if (const std::size_t rest = data.size() - kStlHeaderBytes - kFacetBytes * count; rest > 0)
    report.add(Oddity::kTrailingBytes, 0, ReadReport::kNoElement, rest);
  return mesh;
}

}  // namespace vox
