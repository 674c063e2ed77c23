// NanoVDB files from any program. A NanoVDB grid is used in place, by offsets that it holds itself,
// and NanoVDB's validation follows some of them before it checks them. So all are checked here
// first.

#include "libvox/io/read_nvdb.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/input_file.h"

#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/NanoToOpenVDB.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace vox {
namespace {

/// Says what is wrong with a file, without its name.
struct NvdbFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct NvdbTooLarge : NvdbFault {
  using NvdbFault::NvdbFault;
};

[[noreturn]] void refuseDamaged(const std::string& what) {
  throw NvdbFault("is damaged: " + what);
}

/// The rest of a file, never read beyond its end.
class NvdbStream {
 public:
  explicit NvdbStream(const std::filesystem::path& file)
      : stream_(file, std::ios::binary), left_(std::filesystem::file_size(file)) {
    if (!stream_) throw NvdbFault("cannot be opened; check its permissions");
  }

  std::uint64_t left() const { return left_; }

  void read(char* bytes, std::uint64_t count) {
    if (count > left_ || !stream_.read(bytes, static_cast<std::streamsize>(count)))
      throw NvdbFault("is truncated");
    left_ -= count;
  }

  template <class Value>
  Value next() {
    Value value;
    read(reinterpret_cast<char*>(&value), sizeof(Value));
    return value;
  }

  std::string text(std::uint64_t size) {
    if (size > left_) throw NvdbFault("is truncated");
    std::string bytes(size, '\0');
    read(bytes.data(), size);
    return bytes;
  }

 private:
  std::ifstream stream_;
  std::uint64_t left_;
};

/// The bytes of one grid, aligned as NanoVDB needs them.
class NanoBytes {
 public:
  explicit NanoBytes(std::uint64_t size)
      : size_(size),
        blocks_(
            std::make_unique_for_overwrite<Block[]>((size + sizeof(Block) - 1) / sizeof(Block))) {}
  char* data() { return blocks_[0].bytes; }
  const char* data() const { return blocks_[0].bytes; }
  std::uint64_t size() const { return size_; }

 private:
  struct alignas(NANOVDB_DATA_ALIGNMENT) Block {
    char bytes[NANOVDB_DATA_ALIGNMENT];
  };
  std::uint64_t size_;
  std::unique_ptr<Block[]> blocks_;
};

void unpackZip(NvdbStream& in, NanoBytes& grid) {
  const std::string packed = in.text(in.next<std::uint64_t>());
  uLongf size = grid.size();
  const int status = uncompress(reinterpret_cast<Bytef*>(grid.data()), &size,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (status != Z_OK || size != grid.size()) refuseDamaged("its zip data cannot be unpacked");
}

/// In chunks of a size that blosc can count.
void unpackBlosc(NvdbStream& in, NanoBytes& grid) {
  constexpr std::uint64_t kChunk = nanovdb::io::Internal::MAX_SIZE;
  for (std::uint64_t done = 0; done < grid.size(); done += kChunk) {
    const std::uint64_t chunk = std::min(kChunk, grid.size() - done);
    const std::string packed = in.text(in.next<std::uint64_t>());
    std::size_t size = 0;
    const bool isSound = blosc_cbuffer_validate(packed.data(), packed.size(), &size) == 0 &&
                         size == chunk &&
                         blosc_decompress_ctx(packed.data(), grid.data() + done, chunk, 1) ==
                             static_cast<int>(chunk);
    if (!isSound) refuseDamaged("its blosc data cannot be unpacked");
  }
}

NanoBytes unpack(NvdbStream& in, std::uint64_t size, nanovdb::io::Codec codec) {
  constexpr std::uint64_t kMostRatio = 1100;  // of zip; that of blosc is 255
  const std::uint64_t most = codec == nanovdb::io::Codec::NONE ? 1 : kMostRatio;
  if (size / most > in.left()) refuseDamaged("a grid is larger than the file can hold");
  if (size < sizeof(nanovdb::GridData)) refuseDamaged("a grid is too small");
  if (size > availableMemory())
    throw NvdbTooLarge("a grid of " + formatBytes(size) + " does not fit into memory");
  NanoBytes grid(size);
  switch (codec) {
    case nanovdb::io::Codec::NONE:
      in.read(grid.data(), size);
      break;
    case nanovdb::io::Codec::ZIP:
      unpackZip(in, grid);
      break;
    case nanovdb::io::Codec::BLOSC:
      unpackBlosc(in, grid);
      break;
    default:
      refuseDamaged("its compression is unknown");
  }
  return grid;
}

/// Checks offsets of a grid: every object that is named lies within its bytes.
class Places {
 public:
  explicit Places(const NanoBytes& grid) : begin_(grid.data()), size_(grid.size()) {}

  std::uint64_t offsetOf(const void* object) const {
    return static_cast<std::uint64_t>(static_cast<const char*>(object) - begin_);
  }

  /// The bytes from an offset to the end.
  std::uint64_t bytesFrom(const void* origin, std::int64_t offset) const {
    const std::uint64_t place = offsetOf(origin) + static_cast<std::uint64_t>(offset);
    return place > size_ ? 0 : size_ - place;
  }

  /// The first of some objects at an offset.
  template <class Object>
  const Object& at(const void* origin, std::int64_t offset, std::uint64_t count = 1) const {
    const std::uint64_t place = offsetOf(origin) + static_cast<std::uint64_t>(offset);
    if (place % NANOVDB_DATA_ALIGNMENT != 0 || bytesFrom(origin, offset) / sizeof(Object) < count)
      refuseDamaged("an offset leads out of a grid");
    return *reinterpret_cast<const Object*>(begin_ + place);
  }

 private:
  const char* begin_;
  std::uint64_t size_;
};

/// A name of any length, as the converter will read it.
void requireName(const nanovdb::GridData& head, const Places& places) {
  const auto requireEnd = [](const char* name, std::uint64_t most) {
    if (std::memchr(name, '\0', most) == nullptr) refuseDamaged("a name has no end");
  };
  requireEnd(head.mGridName, nanovdb::GridData::MaxNameSize);
  if ((head.mFlags & static_cast<std::uint32_t>(nanovdb::GridFlags::HasLongGridName)) == 0) return;
  if (head.mBlindMetadataCount == 0) refuseDamaged("a long name is missing");
  const auto& last = (&places.at<nanovdb::GridBlindMetaData>(
      &head, head.mBlindMetadataOffset, head.mBlindMetadataCount))[head.mBlindMetadataCount - 1];
  const std::uint64_t bytes = places.bytesFrom(&last, last.mByteOffset);
  if (bytes == 0) refuseDamaged("a long name is missing");
  requireEnd(last.getBlindData<char>(), bytes);
}

/// A node that does not know its place.
struct UnplacedNode {
  const nanovdb::CoordBBox* box;  ///< of its active voxels: empty
  nanovdb::Coord origin;
};

/// Checks the nodes of a grid: each lies within it, where its parent says, and they are as many as
/// the tree counts. So neither the validation nor the conversion leaves the bytes of the grid, and
/// the result is not much larger than these.
template <class Build>
class NodeCheck {
 public:
  NodeCheck(const Places& places, const nanovdb::GridData& head)
      : places_(places), tree_(*places.at<nanovdb::NanoTree<Build>>(&head, sizeof(head)).data()) {
    requireRow<Leaf>(head);
    requireRow<Lower>(head);
    requireRow<Upper>(head);
    checkRoot(places.at<Root>(&tree_, static_cast<std::int64_t>(tree_.mNodeOffset[3])));
    for (std::size_t level = 0; level < counts_.size(); ++level)
      if (counts_[level] != tree_.mNodeCount[level]) refuseDamaged("nodes are missing");
  }

  /// The place of these must be set before the grid is used.
  const std::vector<UnplacedNode>& unplaced() const { return unplaced_; }

 private:
  using Root = nanovdb::NanoRoot<Build>;
  using Upper = nanovdb::NanoUpper<Build>;
  using Lower = nanovdb::NanoLower<Build>;
  using Leaf = nanovdb::NanoLeaf<Build>;

  /// The nodes of a level lie one behind the other, if the grid says so.
  template <class Node>
  void requireRow(const nanovdb::GridData& head) const {
    const std::uint64_t count = tree_.mNodeCount[Node::LEVEL];
    const auto offset = static_cast<std::int64_t>(tree_.mNodeOffset[Node::LEVEL]);
    const bool inRow =
        (head.mFlags & static_cast<std::uint32_t>(nanovdb::GridFlags::IsBreadthFirst)) != 0;
    if (count > places_.bytesFrom(&head, 0) / sizeof(Node)) refuseDamaged("it has too many nodes");
    if (count == 0 || !inRow) return;
    if (offset == 0) refuseDamaged("nodes are missing");
    places_.at<Node>(&tree_, offset, Node::FIXED_SIZE ? count : 1);
  }

  /// A truth value must be 0 or 1; to look at another one is undefined.
  template <class Value>
  static void requireValue(const Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      std::uint8_t byte = 0;
      std::memcpy(&byte, &value, 1);
      if (byte > 1) refuseDamaged("a value is neither true nor false");
    }
  }

  void checkRoot(const Root& root) {
    const auto& data = *root.data();
    requireValue(data.mBackground);
    if (data.mTableSize > 0) places_.at<typename Root::Tile>(&root, sizeof(root), data.mTableSize);
    std::set<std::array<std::int32_t, 3>> taken;
    for (std::uint32_t n = 0; n < data.mTableSize; ++n) {
      const auto& tile = *data.tile(n);
      const nanovdb::Coord origin = tile.origin();
      if (((origin[0] | origin[1] | origin[2]) & static_cast<std::int32_t>(Upper::MASK)) != 0 ||
          !taken.insert({origin[0], origin[1], origin[2]}).second)
        refuseDamaged("a node has an impossible place");
      if (tile.isChild())
        check(places_.at<Upper>(&root, tile.child), origin);
      else
        requireValue(tile.value);
    }
  }

  template <class Node>
  void check(const Node& node, const nanovdb::Coord& origin) {
    if (++counts_[Node::LEVEL] > tree_.mNodeCount[Node::LEVEL])
      refuseDamaged("it has more nodes than it says");
    requirePlace(node, origin);
    if constexpr (std::is_same_v<Build, nanovdb::FpN> && Node::LEVEL == 0) {
      constexpr unsigned kMostLog = 4;  // 16 bits
      const unsigned log = node.data()->mFlags >> 5U;
      if (log > kMostLog || places_.bytesFrom(&node, sizeof(Node)) < (std::uint64_t{64} << log))
        refuseDamaged("the values of a leaf are missing");
    }
    if constexpr (Node::LEVEL > 0) checkChildren(node, origin);
  }

  /// A node knows its place by the box of its active voxels. NanoVDB makes empty boxes for nodes
  /// that have none.
  template <class Node>
  void requirePlace(const Node& node, const nanovdb::Coord& origin) {
    if constexpr (Node::LEVEL > 0) {
      if (node.data()->mBBox.empty()) {
        unplaced_.push_back({&node.data()->mBBox, origin});
        return;
      }
    }
    if (node.origin() != origin) refuseDamaged("a node is not where its parent says");
  }

  template <class Node>
  void checkChildren(const Node& node, const nanovdb::Coord& origin) {
    using Child = typename Node::ChildNodeType;
    const auto& data = *node.data();
    for (std::uint32_t n = 0; n < Node::SIZE; ++n) {
      if (!data.mChildMask.isOn(n)) {
        requireValue(data.mTable[n].value);
        continue;
      }
      if (data.mValueMask.isOn(n)) refuseDamaged("a node is a tile, too");
      const nanovdb::Coord local = Node::OffsetToLocalCoord(n);
      check(places_.at<Child>(&node, data.mTable[n].child), origin + (local << Child::TOTAL));
    }
  }

  const Places& places_;
  const nanovdb::TreeData<3>& tree_;
  std::vector<UnplacedNode> unplaced_;
  std::array<std::uint64_t, 3> counts_{};  // by level
};

/// NanoVDB multiplies a matrix by a column, OpenVDB a row by a matrix. (The converter means to
/// transpose, but drops the result: turned grids would turn the other way.)
openvdb::math::Transform::Ptr transformOf(const nanovdb::Map& map) {
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix(row, column) = map.mMatD[3 * column + row];
    matrix(3, row) = map.mVecD[row];
  }
  return openvdb::math::Transform::createLinearTransform(matrix);
}

template <class Build>
openvdb::GridBase::Ptr decoded(NanoBytes& bytes) {
  const auto& grid = *reinterpret_cast<const nanovdb::NanoGrid<Build>*>(bytes.data());
  const Places places(bytes);
  const NodeCheck<Build> nodes(places, *grid.data());
  const std::string wrong = nanovdb::GridValidator<Build>::check(grid, /*detailed=*/true);
  if (!wrong.empty()) refuseDamaged("NanoVDB says: " + wrong);
  for (const UnplacedNode& node : nodes.unplaced()) {  // after the checksum is compared
    const nanovdb::CoordBBox box(node.origin, node.origin - nanovdb::Coord(1));
    std::memcpy(bytes.data() + places.offsetOf(node.box), &box, sizeof(box));
  }
  openvdb::GridBase::Ptr made = nanovdb::nanoToOpenVDB(grid);
  made->setTransform(transformOf(grid.map()));
  return made;
}

openvdb::GridBase::Ptr decode(NanoBytes bytes) {
  const auto& head = *reinterpret_cast<const nanovdb::GridData*>(bytes.data());
  if (head.mMagic != NANOVDB_MAGIC_NUMBER || head.mGridSize != bytes.size() || head.mGridIndex != 0)
    refuseDamaged("a grid does not begin as a NanoVDB grid does");
  if (head.mVersion.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
    refuseDamaged("a grid is of another version than the file");
  const auto isFinite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(std::begin(head.mMap.mMatD), std::end(head.mMap.mMatD), isFinite) ||
      !std::all_of(std::begin(head.mMap.mVecD), std::end(head.mMap.mVecD), isFinite))
    refuseDamaged("a transform is not finite");
  requireName(head, Places(bytes));
  using nanovdb::GridType;
  switch (head.mGridType) {
    case GridType::Float:
      return decoded<float>(bytes);
    case GridType::Double:
      return decoded<double>(bytes);
    case GridType::Int32:
      return decoded<std::int32_t>(bytes);
    case GridType::Int64:
      return decoded<std::int64_t>(bytes);
    case GridType::Vec3f:
      return decoded<nanovdb::Vec3f>(bytes);
    case GridType::Vec3d:
      return decoded<nanovdb::Vec3d>(bytes);
    case GridType::Mask:
      return decoded<nanovdb::ValueMask>(bytes);
    case GridType::Boolean:
      return decoded<bool>(bytes);
    case GridType::Fp4:
      return decoded<nanovdb::Fp4>(bytes);
    case GridType::Fp8:
      return decoded<nanovdb::Fp8>(bytes);
    case GridType::Fp16:
      return decoded<nanovdb::Fp16>(bytes);
    case GridType::FpN:
      return decoded<nanovdb::FpN>(bytes);
    default:
      break;
  }
  if (head.mGridType >= GridType::End) refuseDamaged("the type of a grid is unknown");
  throw NvdbFault(std::string("has a grid of type ") + nanovdb::toStr(head.mGridType) +
                  ", which OpenVDB does not have");
}

/// @throws NvdbFault  it is of another version, or no NanoVDB file
void requireReadable(const nanovdb::io::Header& header) {
  constexpr std::uint64_t kAllButTheLast = 0x00ff'ffff'ffff'ffff;  // "NanoVDB", then a digit
  if (header.magic != NANOVDB_MAGIC_NUMBER &&
      (header.magic & kAllButTheLast) == (NANOVDB_MAGIC_NUMBER & kAllButTheLast))
    throw NvdbFault("is of a newer NanoVDB than this one, version " +
                    std::to_string(NANOVDB_MAJOR_VERSION_NUMBER));
  if (header.magic != NANOVDB_MAGIC_NUMBER) throw NvdbFault("is not a NanoVDB file");
  if (header.version.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
    throw NvdbFault("is of NanoVDB " + std::to_string(header.version.getMajor()) +
                    "; only version " + std::to_string(NANOVDB_MAJOR_VERSION_NUMBER) +
                    " can be read");
}

void readSegment(NvdbStream& in, const std::function<void(const openvdb::GridBase::Ptr&)>& visit) {
  const auto header = in.next<nanovdb::io::Header>();
  requireReadable(header);
  std::vector<std::uint64_t> sizes;
  for (int n = 0; n < header.gridCount; ++n) {
    const auto grid = in.next<nanovdb::io::MetaData>();
    in.text(grid.nameSize);  // the grid has it, too
    sizes.push_back(grid.gridSize);
  }
  for (const std::uint64_t size : sizes) visit(decode(unpack(in, size, header.codec)));
}

}  // namespace

void readNvdb(const std::filesystem::path& file,
              const std::function<void(const openvdb::GridBase::Ptr&)>& visit) {
  requireInputFile(file);
  try {
    NvdbStream in(file);
    while (in.left() > 0) readSegment(in, visit);
  } catch (const NvdbTooLarge& wrong) {
    throw LimitError(file.string() + ": " + wrong.what());
  } catch (const NvdbFault& wrong) {
    throw InputError(file.string() + ": " + wrong.what());
  }
}

}  // namespace vox
