// Files, compared with the least possible work. file/write and file/read: OpenVDB with our hash.
// rawWrite and rawRead: the same bytes without OpenVDB. memory/copy: the same bytes in memory. In
// all of them a file that was just written is read from the system's cache.

#include "apps/bench/file_bench.h"

#include "apps/bench/inputs.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/write_vdb.h"
#include "libvox/pipeline/convert.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace vox::bench {
namespace {

constexpr int kDim = 1024;

/// A temporary file; removed by the destructor.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path(std::filesystem::temp_directory_path() /
             ("vox_bench_" + std::to_string(::getpid()) + "_" + name)) {}
  ~TemporaryFile() { std::filesystem::remove(path); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::filesystem::path path;
};

/// Grids of the generated torus; made at the first call.
const std::vector<openvdb::GridBase::Ptr>& gridsOf(GridKind kind) {
  static std::map<GridKind, std::vector<openvdb::GridBase::Ptr>> known;
  auto& grids = known[kind];
  if (grids.empty()) {
    Scene scene;
    scene.objects.push_back({"torus", makeInput("torus")});
    ConvertOptions options;
    options.dim = kDim;
    options.grids = std::vector{kind};
    grids = convert(scene, options).grids;
  }
  return grids;
}

void write(const std::filesystem::path& file, GridKind kind) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
  writeVdb(stream, gridsOf(kind), {});
}

void setBytes(benchmark::State& state, std::uint64_t bytes) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
}

void writeGrids(benchmark::State& state, GridKind kind) {
  const TemporaryFile file("write.vdb");
  for (auto _ : state) write(file.path, kind);
  setBytes(state, std::filesystem::file_size(file.path));
}

void readGrids(benchmark::State& state, GridKind kind) {
  const TemporaryFile file("read.vdb");
  write(file.path, kind);
  for (auto _ : state)
    forEachGrid(file.path,
                [](const NamedGrid& named) { named.grid->baseTree().readNonresidentBuffers(); });
  setBytes(state, std::filesystem::file_size(file.path));
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeBytes(benchmark::State& state, GridKind kind) {
  const TemporaryFile grids("grids.vdb");
  write(grids.path, kind);
  const std::string bytes = bytesOf(grids.path);
  const TemporaryFile file("bytes");
  for (auto _ : state) {
    std::ofstream stream(file.path, std::ios::binary | std::ios::trunc);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  setBytes(state, bytes.size());
}

void readBytes(benchmark::State& state, GridKind kind) {
  const TemporaryFile file("bytes.vdb");
  write(file.path, kind);
  std::string bytes(std::filesystem::file_size(file.path), '\0');
  for (auto _ : state) {
    std::ifstream stream(file.path, std::ios::binary);
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    benchmark::DoNotOptimize(bytes.data());
  }
  setBytes(state, bytes.size());
}

void copyMemory(benchmark::State& state) {
  constexpr std::size_t kBytes = std::size_t{256} << 20U;
  const std::vector<char> from(kBytes, 1);
  std::vector<char> to(kBytes);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), kBytes);
    benchmark::ClobberMemory();
  }
  setBytes(state, kBytes);
}

}  // namespace

void registerFiles() {
  const auto add = [](std::string_view name, auto run, auto... arguments) {
    benchmark::RegisterBenchmark(std::string(name).c_str(), run, arguments...)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  for (const GridKind kind : {GridKind::kMask, GridKind::kDensity, GridKind::kNormal}) {
    const std::string name = nameIn(kGridNames, kind);
    add("file/write/" + name, writeGrids, kind);
    add("file/rawWrite/" + name, writeBytes, kind);
    add("file/read/" + name, readGrids, kind);
    add("file/rawRead/" + name, readBytes, kind);
  }
  add("memory/copy", copyMemory);
}

}  // namespace vox::bench
