// Files, compared with the least possible work. file/write and file/read: OpenVDB with our hash.
// file/sync: the file is synced and renamed, too. After each writing, the same bytes are written in
// the same way without OpenVDB; the counters are the median of its milliseconds and the median
// ratio of the pairs. rawRead: the same bytes read without OpenVDB. memory/copy: the same bytes in
// memory. In all of them a file that was just written is read from the system's cache.

#include "apps/bench/file_bench.h"

#include "apps/bench/inputs.h"
#include "apps/bench/statistics.h"
#include "libvox/core/stopwatch.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/atomic_file.h"
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

/// Voxels across. Masks are small, so there the largest one counts.
int dimOf(GridKind kind) {
  return kind == GridKind::kMask ? 2048 : 1024;
}

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
    options.dim = dimOf(kind);
    options.grids = std::vector{kind};
    grids = convert(scene, options).grids;
  }
  return grids;
}

void write(std::iostream& stream, GridKind kind) {
  writeVdb(stream, gridsOf(kind), {});
}

/// Makes a file anew; what it replaces is removed before.
template <class Write>
void makeFile(const std::filesystem::path& path, const Write& write) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
  write(file);
}

/// Makes a file as `vox convert` does: synced and then renamed.
template <class Write>
void makeSynced(const std::filesystem::path& path, const Write& write) {
  AtomicFile file(path, false);
  write(file.stream());
  file.commit();
}

void setBytes(benchmark::State& state, std::uint64_t bytes) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Seconds to make a file that does not exist.
template <class Make>
double secondsOf(const std::filesystem::path& path, const Make& make) {
  std::filesystem::remove(path);
  const Stopwatch watch;
  make(path);
  return watch.seconds();
}

void writeGrids(benchmark::State& state, GridKind kind, bool synced) {
  const TemporaryFile file("write.vdb");
  const auto make = [&](const std::filesystem::path& path, const auto& write) {
    synced ? makeSynced(path, write) : makeFile(path, write);
  };
  const auto grids = [&](const auto& path) {
    make(path, [&](std::iostream& stream) { write(stream, kind); });
  };
  grids(file.path);
  const std::string bytes = bytesOf(file.path);
  const auto plain = [&](const auto& path) {
    make(path, [&](std::iostream& stream) {
      stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    });
  };
  std::vector<double> ours, plainly;
  for (auto _ : state) {
    ours.push_back(secondsOf(file.path, grids));
    state.SetIterationTime(ours.back());
    plainly.push_back(secondsOf(file.path, plain));
  }
  state.counters["plain_ms"] = 1e3 * median(plainly);
  state.counters["ratio"] = median(ratios(plainly, ours));
  setBytes(state, bytes.size());
}

void readGrids(benchmark::State& state, GridKind kind) {
  const TemporaryFile file("read.vdb");
  makeFile(file.path, [&](std::iostream& stream) { write(stream, kind); });
  for (auto _ : state)
    forEachGrid(file.path,
                [](const NamedGrid& named) { named.grid->baseTree().readNonresidentBuffers(); });
  setBytes(state, std::filesystem::file_size(file.path));
}

void readBytes(benchmark::State& state, GridKind kind) {
  const TemporaryFile file("bytes.vdb");
  makeFile(file.path, [&](std::iostream& stream) { write(stream, kind); });
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
    return benchmark::RegisterBenchmark(std::string(name).c_str(), run, arguments...)
        ->Unit(benchmark::kMillisecond);
  };
  for (const GridKind kind : {GridKind::kMask, GridKind::kDensity, GridKind::kNormal}) {
    const std::string name = nameIn(kGridNames, kind);
    add("file/write/" + name, writeGrids, kind, false)->UseManualTime();
    add("file/sync/" + name, writeGrids, kind, true)->UseManualTime();
    add("file/read/" + name, readGrids, kind)->UseRealTime();
    add("file/rawRead/" + name, readBytes, kind)->UseRealTime();
  }
  add("memory/copy", copyMemory)->UseRealTime();
}

}  // namespace vox::bench
