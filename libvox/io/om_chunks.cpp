// Source: OpenMesh 9.0, Core/IO/OMFormat.hh, and files written by it.

#include "libvox/io/om_chunks.h"

#include "libvox/core/error.h"
#include "libvox/io/byte_order.h"

#include <cstddef>
#include <limits>
#include <utility>

namespace vox {

namespace {

constexpr std::size_t kOmHeaderBytes = 16;
constexpr std::uint8_t kNewestVersion = 2U << 5 | 2U;    // 2.2, written by OpenMesh 9
constexpr std::uint8_t kHalfedgeVersion = 2U << 5;       // 2.0 and later store half-edges
constexpr std::uint8_t kTypeNameVersion = 2U << 5 | 2U;  // custom properties have a type name
constexpr unsigned kInteger32 = 2;                       // ChunkHeader::bits
constexpr unsigned kFloat64 = 1;

struct Header {
  char meshKind;  // T, Q or P
  std::uint8_t version;
  std::uint32_t vertexCount, faceCount, edgeCount;
};

enum Entity : unsigned {
  kEntityVertex = 0,
  kEntityMesh = 1,
  kEntityFace = 2,
  kEntityEdge = 4,
  kEntityHalfedge = 6,
  kEntitySentinel = 7
};

enum Type : unsigned {
  kTypePos = 0,
  kTypeNormal = 1,
  kTypeTexcoord = 2,
  kTypeStatus = 3,
  kTypeColor = 4,
  kTypeCustom = 6,
  kTypeTopology = 7
};

struct ChunkHeader {
  bool named, isFloat;
  unsigned entity, type, dimension;
  unsigned bits;  // log2 of the bytes of an integer; of a quarter of the bytes of a float
};

ChunkHeader unpack(std::uint16_t packed) {
  const auto field = [&](int offset, int size) { return (packed >> offset) & ((1U << size) - 1); };
  return {.named = field(1, 1) != 0,
          .isFloat = field(10, 1) != 0,
          .entity = field(2, 3),
          .type = field(5, 4),
          .dimension = field(11, 3) + 1,
          .bits = field(14, 2)};
}

// Walks the chunks of a file and copies the ones that make the mesh.
class ChunkFilter {
 public:
  ChunkFilter(std::string_view data, const std::string& fileName)
      : data_(data), fileName_(fileName) {}

  OmMesh filter() {
    readHeader();
    while (readChunk()) {
    }
    for (const auto& [kind, name] :
         {std::pair{kPositions, "vertex positions"}, std::pair{kFaces, "faces"},
          std::pair{kHalfedges, "half-edges"}})
      if (!(found_ & kind) && (kind != kHalfedges || header_.version >= kHalfedgeVersion))
        fail(std::string("damaged: it has no ") + name);
    kept_ += kEndOfFile;
    return {std::move(kept_), header_.vertexCount, header_.faceCount};
  }

 private:
  enum Kept : unsigned { kNothing = 0, kPositions = 1, kFaces = 2, kHalfedges = 4, kStatus = 8 };
  static constexpr std::string_view kEndOfFile{"\x1c\0", 2};  // sentinel chunk

  void readHeader();
  bool readChunk();
  std::uint64_t elementCount(unsigned entity) const;
  Kept kindOf(const ChunkHeader& chunk) const;
  std::uint64_t dataBytes(const ChunkHeader& chunk) const;
  std::uint64_t polygonBytes(unsigned indexBytes) const;
  void skipName();
  void checkLayout(const ChunkHeader& chunk, Kept kind) const;
  std::string_view take(std::uint64_t bytes);
  template <typename T>
  T takeNumber() {
    return loadNumber<T>(take(sizeof(T)).data(), std::endian::little);
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fileName_ + ": " + what);
  }

  std::string_view data_;
  const std::string& fileName_;
  std::size_t at_ = 0;
  Header header_{};
  unsigned found_ = 0;
  std::string kept_;
};

void ChunkFilter::readHeader() {
  if (data_.size() < kOmHeaderBytes || !data_.starts_with("OM"))
    fail("no OM file: it does not start with OM and a header of 16 bytes");
  take(2);
  header_ = {takeNumber<char>(), takeNumber<std::uint8_t>(), takeNumber<std::uint32_t>(),
             takeNumber<std::uint32_t>(), takeNumber<std::uint32_t>()};
  if (header_.meshKind != 'T' && header_.meshKind != 'Q' && header_.meshKind != 'P')
    fail("no OM file: the mesh kind is none of T, Q, P");
  if (header_.version > kNewestVersion)
    fail("OM version " + std::to_string(header_.version >> 5) + "." +
         std::to_string(header_.version & 31) +
         " is newer than 2.2; save it with an older OpenMesh or as PLY");
  constexpr std::uint32_t kLargest = std::numeric_limits<int>::max() / 2;  // handles are int
  if (header_.vertexCount > kLargest || header_.faceCount > kLargest ||
      header_.edgeCount > kLargest)
    fail("damaged: the header promises " + std::to_string(header_.vertexCount) + " vertices, " +
         std::to_string(header_.edgeCount) + " edges, " + std::to_string(header_.faceCount) +
         " faces");
  kept_ = data_.substr(0, kOmHeaderBytes);
}

// Reads one chunk; returns false at the end. A missing sentinel is accepted, as OpenMesh does.
bool ChunkFilter::readChunk() {
  if (at_ == data_.size()) return false;
  const std::size_t begin = at_;
  const ChunkHeader chunk = unpack(takeNumber<std::uint16_t>());
  if (chunk.entity == kEntitySentinel) return false;
  if (chunk.named) skipName();
  if (chunk.named && chunk.type == kTypeCustom && header_.version >= kTypeNameVersion) skipName();

  const Kept kind = kindOf(chunk);
  if (kind != kNothing) {
    if (found_ & kind) fail("damaged: the chunk at byte " + std::to_string(begin) + " comes twice");
    if (chunk.named) fail("damaged: the chunk at byte " + std::to_string(begin) + " has a name");
    checkLayout(chunk, kind);
    found_ |= kind;
  }
  take(dataBytes(chunk));
  if (kind != kNothing) kept_ += data_.substr(begin, at_ - begin);
  return true;
}

std::uint64_t ChunkFilter::elementCount(unsigned entity) const {
  switch (entity) {
    case kEntityVertex:
      return header_.vertexCount;
    case kEntityFace:
      return header_.faceCount;
    case kEntityEdge:
      return header_.edgeCount;
    case kEntityHalfedge:
      return std::uint64_t{2} * header_.edgeCount;
    case kEntityMesh:
      return 1;
    default:
      fail("damaged: unknown kind of chunk before byte " + std::to_string(at_));
  }
}

ChunkFilter::Kept ChunkFilter::kindOf(const ChunkHeader& chunk) const {
  if (chunk.entity == kEntityVertex && chunk.type == kTypePos) return kPositions;
  if (chunk.entity == kEntityFace && chunk.type == kTypeTopology) return kFaces;
  if (chunk.entity == kEntityFace && chunk.type == kTypeStatus) return kStatus;
  const bool connects = chunk.entity == kEntityHalfedge && chunk.type == kTypeTopology;
  return connects && header_.version >= kHalfedgeVersion ? kHalfedges : kNothing;
}

// Refuses layouts on which OpenMesh asserts, or of which it would read another number of bytes than
// dataBytes.
void ChunkFilter::checkLayout(const ChunkHeader& chunk, Kept kind) const {
  if (kind == kPositions && (!chunk.isFloat || chunk.bits > kFloat64 || chunk.dimension != 3))
    fail("vertex positions are not three floats or doubles; save it again with OpenMesh 9");
  if ((kind == kFaces || kind == kHalfedges) && chunk.bits > kInteger32)
    fail("connectivity has 64-bit indices, which OpenMesh cannot read; save it as PLY");
  if (kind == kStatus && chunk.dimension != 1) fail("damaged: face status of several dimensions");
}

std::uint64_t ChunkFilter::dataBytes(const ChunkHeader& chunk) const {
  const std::uint64_t count = elementCount(chunk.entity);
  const std::uint64_t scalarBytes = std::uint64_t{chunk.isFloat ? 4U : 1U} << chunk.bits;
  const unsigned indexBytes = 1U << chunk.bits;
  switch (chunk.type) {
    case kTypeCustom:
      return sizeof(std::uint32_t) +
             (data_.size() - at_ < sizeof(std::uint32_t)
                  ? 0
                  : loadNumber<std::uint32_t>(data_.data() + at_, std::endian::little));
    case kTypeStatus:
      return 4 * count;  // OpenMesh ignores the size in the chunk header
    case kTypeTopology:
      if (chunk.entity == kEntityFace && header_.version < kHalfedgeVersion)
        return polygonBytes(indexBytes);
      // A half-edge: next half-edge, vertex, face.
      return count * indexBytes * (chunk.entity == kEntityHalfedge ? 3 : 1);
    case kTypePos:
    case kTypeNormal:
    case kTypeTexcoord:
    case kTypeColor:
      return count * chunk.dimension * scalarBytes;
    default:
      fail("damaged: unknown type of chunk before byte " + std::to_string(at_));
  }
}

// Bytes of the faces in versions before 2: the vertex indices of each face; in a mesh of kind P
// each face starts with its number of corners, 16 bits.
std::uint64_t ChunkFilter::polygonBytes(unsigned indexBytes) const {
  if (header_.meshKind != 'P')
    return std::uint64_t{header_.faceCount} * indexBytes * (header_.meshKind == 'T' ? 3 : 4);
  std::uint64_t end = at_;
  for (std::uint32_t f = 0; f < header_.faceCount; ++f) {
    if (end + 2 > data_.size())
      fail("truncated: ends within face " + std::to_string(f) + " of " +
           std::to_string(header_.faceCount));
    end += 2 + std::uint64_t{indexBytes} *
                   loadNumber<std::uint16_t>(data_.data() + end, std::endian::little);
  }
  return end - at_;
}

void ChunkFilter::skipName() {
  take(takeNumber<std::uint8_t>());
}

std::string_view ChunkFilter::take(std::uint64_t bytes) {
  if (bytes > data_.size() - at_)
    fail("truncated, or damaged: the chunk at byte " + std::to_string(at_) + " needs " +
         std::to_string(bytes) + " bytes, " + std::to_string(data_.size() - at_) + " remain");
  const std::string_view taken = data_.substr(at_, bytes);
  at_ += bytes;
  return taken;
}

}  // namespace

OmMesh omMeshOnly(std::string_view data, const std::string& fileName) {
  return ChunkFilter(data, fileName).filter();
}

}  // namespace vox
