#pragma once

#include "apps/bench/process.h"
#include "apps/bench/statistics.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vox::bench {

/// A program under the name it has in tables.
struct Program {
  std::string name;
  std::vector<std::string> command;
};

/// What the runs of one program gave; values of run i stand at i.
struct Side {
  Program program;
  ProcessRun last = {};
  std::vector<double> wallSeconds = {};
  std::vector<double> cpuSeconds = {};
  std::vector<double> peakBytes = {};
  std::optional<std::uint64_t> voxels = {};  ///< as it says

  bool ok() const { return last.outcome == Outcome::kOk; }
};

/// Two programs in turn. Ratios are B / A: above 1, B takes more.
struct Comparison {
  std::string name;
  Side a;
  Side b;

  std::vector<double> wallRatios() const { return ratios(a.wallSeconds, b.wallSeconds); }
  std::vector<double> cpuRatios() const { return ratios(a.cpuSeconds, b.cpuSeconds); }
  std::vector<double> peakRatios() const { return ratios(a.peakBytes, b.peakBytes); }
  /// Of CPU time per voxel; empty unless both say how many voxels they made.
  std::vector<double> cpuPerVoxelRatios() const;
};

/// Hears what is about to run: "NAME: PROGRAM, run 2 of 5".
using Progress = std::function<void(const std::string&)>;

/// Runs A B A B ..., so that whatever slows the machine down meets both. A program that does not
/// succeed is not run again; the other one goes on.
Comparison compare(const std::string& name, const Program& a, const Program& b, int pairs,
                   const Limits& limits, const Progress& progress);

/// Runs of programs in turn: A B C A B C ... Those that do not succeed are not run again.
std::vector<Side> measureInTurn(const std::string& name, const std::vector<Program>& programs,
                                int runs, const Limits& limits, const Progress& progress);

/// One program alone.
Side measure(const Program& program, int runs, const Limits& limits, const Progress& progress);

}  // namespace vox::bench
