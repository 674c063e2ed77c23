// Files of grids from any program. They are not trusted, unless their hash shows that libvox wrote
// them.

#include "libvox/io/read_vdb.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/grid_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_nvdb.h"
#include "libvox/io/write_vdb.h"

#include <openvdb/io/Stream.h>

#include <array>
#include <fstream>
#include <ios>
#include <map>
#include <new>
#include <string_view>

namespace vox {
namespace {

/// @throws InputError  the file does not begin as an OpenVDB file does
void requireVdb(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened; check its permissions");
  constexpr std::string_view kMagic(" BDV\0\0\0\0", 8);
  std::array<char, kMagic.size()> begin{};
  stream.read(begin.data(), begin.size());
  if (std::string_view(begin.data(), begin.size()) != kMagic)
    throw InputError(file.string() + ": is not an OpenVDB file");
}

using Visit = std::function<void(const openvdb::GridBase::Ptr&)>;
using Wants = std::function<bool(const std::string&)>;

bool wantsAll(const std::string& /*name*/) {
  return true;
}

/// Reads a file; OpenVDB loads the values of leaves when they are first used. It trusts the file,
/// and may abort if that is damaged.
openvdb::MetaMap readOnDemand(const std::filesystem::path& file, const Wants& wants,
                              const Visit& visit) {
  openvdb::io::File vdb(file.string());
  vdb.open(/*delayLoad=*/true);
  for (auto name = vdb.beginName(); name != vdb.endName(); ++name)
    if (wants(*name)) visit(vdb.readGrid(*name));
  return *vdb.getMetadata();
}

/// Reads the whole file at once, through a stream that throws at the end of a truncated file.
/// OpenVDB alone would not notice it.
openvdb::MetaMap readWhole(const std::filesystem::path& file, const Visit& visit) {
  std::ifstream stream(file, std::ios::binary);
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  openvdb::io::Stream vdb(stream, /*delayLoad=*/false);
  for (const auto& grid : *vdb.getGrids()) visit(grid);
  return *vdb.getMetadata();
}

/// @throws InputError  for whatever OpenVDB throws
openvdb::MetaMap namingFile(const std::filesystem::path& file,
                            const std::function<openvdb::MetaMap()>& work) {
  openvdb::initialize();
  openvdb::logging::setLevel(openvdb::logging::Level::Fatal);
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::ios_base::failure&) {
    throw InputError(file.string() + ": is truncated or damaged: OpenVDB cannot read it");
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() + ": is damaged, or needs more memory than there is");
  } catch (const std::exception& wrong) {
    constexpr std::size_t kMost = 200;  // damaged files may quote megabytes of themselves
    throw InputError(file.string() +
                     ": cannot be read as OpenVDB: " + std::string(wrong.what()).substr(0, kMost));
  }
}

openvdb::MetaMap read(const std::filesystem::path& file, const Visit& visit) {
  const bool trusted = isSoundOwnVdb(file);
  constexpr std::uintmax_t kMostWhole = std::uintmax_t{256} << 20U;
  const bool nano = isNvdb(file);
  const bool onDemand = trusted || (!nano && std::filesystem::file_size(file) > kMostWhole);
  return namingFile(file, [&] {
    if (nano) return readNvdb(file, visit), openvdb::MetaMap();
    return onDemand ? readOnDemand(file, wantsAll, visit) : readWhole(file, visit);
  });
}

/// Gives each grid a name that no other grid of the file has.
class Namer {
 public:
  NamedGrid named(const openvdb::GridBase::Ptr& grid) {
    const std::string name = grid->getName();
    const int before = seen_[name]++;
    return {before == 0 ? name : name + "[" + std::to_string(before) + "]", grid};
  }

 private:
  std::map<std::string, int> seen_;
};

}  // namespace

bool isSoundOwnVdb(const std::filesystem::path& file) {
  requireInputFile(file);
  if (isNvdb(file)) return false;
  requireVdb(file);
  std::ifstream stream(file, std::ios::binary);
  const VdbContent content = vdbContent(stream);
  if (content == VdbContent::kDamaged)
    throw InputError(file.string() + ": is damaged: its content does not match its hash");
  return content == VdbContent::kIntact;
}

VdbFile readVdb(const std::filesystem::path& file) {
  VdbFile all;
  Namer namer;
  all.metadata = std::make_shared<openvdb::MetaMap>(read(
      file, [&](const openvdb::GridBase::Ptr& grid) { all.grids.push_back(namer.named(grid)); }));
  return all;
}

VdbFile readOwnVdb(const std::filesystem::path& file, const Wants& wants) {
  VdbFile all;
  Namer namer;
  all.metadata = std::make_shared<openvdb::MetaMap>(namingFile(file, [&] {
    return readOnDemand(file, wants, [&](const openvdb::GridBase::Ptr& grid) {
      all.grids.push_back(namer.named(grid));
    });
  }));
  return all;
}

void forEachGrid(const std::filesystem::path& file,
                 const std::function<void(const NamedGrid&)>& visit) {
  Namer namer;
  read(file, [&](const openvdb::GridBase::Ptr& grid) { visit(namer.named(grid)); });
}

}  // namespace vox
