// OpenVDB files of any program, not trusted.

#include "libvox/io/read_vdb.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/write_vdb.h"

#include <fstream>

namespace vox {
namespace {

/// A file of ours names the hash of its content; OpenVDB itself trusts what it reads.
void requireIntact(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened; check its permissions");
  if (vdbContent(stream) == VdbContent::kDamaged)
    throw InputError(file.string() + ": is damaged: its content does not match its hash");
}

/// Opens a file for `work`, and says of any failure in there what it is about.
template <class Work>
void withFile(const std::filesystem::path& file, Work&& work) {
  requireInputFile(file);
  openvdb::initialize();
  openvdb::logging::setLevel(openvdb::logging::Level::Fatal);
  requireIntact(file);
  try {
    openvdb::io::File vdb(file.string());
    vdb.open(/*delayLoad=*/true);
    work(vdb);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& wrong) {
    constexpr std::size_t kMost = 200;  // damaged files may quote megabytes of themselves
    throw InputError(file.string() +
                     ": cannot be read as OpenVDB: " + std::string(wrong.what()).substr(0, kMost));
  }
}

}  // namespace

VdbFile readVdb(const std::filesystem::path& file) {
  VdbFile read;
  withFile(file, [&](openvdb::io::File& vdb) {
    read.metadata = *vdb.getMetadata();
    for (auto name = vdb.beginName(); name != vdb.endName(); ++name)
      read.grids.push_back({*name, vdb.readGrid(*name)});
  });
  return read;
}

void forEachGrid(const std::filesystem::path& file,
                 const std::function<void(const NamedGrid&)>& visit) {
  withFile(file, [&](openvdb::io::File& vdb) {
    for (auto name = vdb.beginName(); name != vdb.endName(); ++name)
      visit({*name, vdb.readGrid(*name)});
  });
}

}  // namespace vox
