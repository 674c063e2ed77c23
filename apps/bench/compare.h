#pragma once

#include "apps/bench/process.h"
#include "apps/bench/statistics.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vox::bench {

/// A program, and its name in tables.
struct Program {
  std::string name;
  std::vector<std::string> command;
};

/// Results of the runs of one program; index i is successful run i.
struct Side {
  Program program;
  ProcessRun last = {};
  std::vector<double> wallSeconds = {};
  std::vector<double> cpuSeconds = {};
  std::vector<double> peakBytes = {};
  std::optional<std::uint64_t> voxels = {};  ///< number of active voxels that it printed

  bool ok() const { return last.outcome == Outcome::kOk; }
};

/// Results of two programs that were run in turn. Ratios are B / A: above 1, B takes more.
struct Comparison {
  std::string name;
  Side a;
  Side b;

  std::vector<double> wallRatios() const { return ratios(a.wallSeconds, b.wallSeconds); }
  std::vector<double> cpuRatios() const { return ratios(a.cpuSeconds, b.cpuSeconds); }
  std::vector<double> peakRatios() const { return ratios(a.peakBytes, b.peakBytes); }
  /// Ratios of CPU time per voxel; empty unless both programs printed a number of voxels.
  std::vector<double> cpuPerVoxelRatios() const;
};

/// Called before each run, with a line such as "NAME: PROGRAM, run 2 of 5".
using Progress = std::function<void(const std::string&)>;

/// Runs A B A B ..., so that other load of the machine affects both alike. A program that fails is
/// not run again; the other one goes on.
/// @throws Interrupted  as runProcess
Comparison compare(const std::string& name, const Program& a, const Program& b, int pairs,
                   const Limits& limits, const Progress& progress);

/// Runs several programs in turn: A B C A B C ... A program that fails is not run again.
/// @return one side per program
std::vector<Side> measureInTurn(const std::string& name, const std::vector<Program>& programs,
                                int runs, const Limits& limits, const Progress& progress);

/// Runs one program several times.
Side measure(const Program& program, int runs, const Limits& limits, const Progress& progress);

}  // namespace vox::bench
