// OpenVDB files of any program, not trusted.

#include "libvox/io/read_vdb.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/write_vdb.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <fstream>
#include <map>
#include <new>

namespace vox {
namespace {

/// Whether a file is ours and as we wrote it.
/// @throws InputError  it is ours, but damaged: it names the hash of its content
bool isTrusted(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened; check its permissions");
  const VdbContent content = vdbContent(stream);
  if (content == VdbContent::kDamaged)
    throw InputError(file.string() + ": is damaged: its content does not match its hash");
  return content == VdbContent::kIntact;
}

using Visit = std::function<void(const openvdb::GridBase::Ptr&)>;

/// Values of leaves are read when they are looked at. OpenVDB trusts what it reads and may abort
/// on a damaged file.
openvdb::MetaMap readOnDemand(const std::filesystem::path& file, const Visit& visit) {
  openvdb::io::File vdb(file.string());
  vdb.open(/*delayLoad=*/true);
  for (auto name = vdb.beginName(); name != vdb.endName(); ++name) visit(vdb.readGrid(*name));
  return *vdb.getMetadata();
}

/// The whole file, through a stream that fails where it ends: OpenVDB itself would go on.
openvdb::MetaMap readWhole(const std::filesystem::path& file, const Visit& visit) {
  std::ifstream stream(file, std::ios::binary);
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  openvdb::io::Stream vdb(stream, /*delayLoad=*/false);
  for (const auto& grid : *vdb.getGrids()) visit(grid);
  return *vdb.getMetadata();
}

openvdb::MetaMap read(const std::filesystem::path& file, const Visit& visit) {
  requireInputFile(file);
  openvdb::initialize();
  openvdb::logging::setLevel(openvdb::logging::Level::Fatal);
  constexpr std::uintmax_t kMostWhole = std::uintmax_t{256} << 20U;
  const bool onDemand = isTrusted(file) || std::filesystem::file_size(file) > kMostWhole;
  try {
    return onDemand ? readOnDemand(file, visit) : readWhole(file, visit);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() + ": is damaged, or needs more memory than there is");
  } catch (const std::exception& wrong) {
    constexpr std::size_t kMost = 200;  // damaged files may quote megabytes of themselves
    throw InputError(file.string() +
                     ": cannot be read as OpenVDB: " + std::string(wrong.what()).substr(0, kMost));
  }
}

/// Gives each grid a name of its own.
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

VdbFile readVdb(const std::filesystem::path& file) {
  VdbFile all;
  Namer namer;
  all.metadata = std::make_shared<openvdb::MetaMap>(read(
      file, [&](const openvdb::GridBase::Ptr& grid) { all.grids.push_back(namer.named(grid)); }));
  return all;
}

void forEachGrid(const std::filesystem::path& file,
                 const std::function<void(const NamedGrid&)>& visit) {
  Namer namer;
  read(file, [&](const openvdb::GridBase::Ptr& grid) { visit(namer.named(grid)); });
}

}  // namespace vox
