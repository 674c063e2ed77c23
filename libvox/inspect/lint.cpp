// Faults that viewers stumble over. Facts about Blender hold for version 3.4.1 (DESIGN section 14).

#include "libvox/inspect/lint.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/compared_types.h"
#include "libvox/inspect/leaf_values.h"
#include "libvox/inspect/steep_pairs.h"
#include "libvox/inspect/topology.h"
#include "libvox/io/read_vdb.h"
#include "libvox/options/option_text.h"
#include "libvox/options/part_options.h"

#include <openvdb/tools/Diagnostics.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <type_traits>
#include <utility>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::GridBase;
using openvdb::Index;

class LintFindings {
 public:
  LintFindings(std::vector<LintFinding>& all, std::string grid)
      : all_(all), grid_(std::move(grid)) {}
  void add(const std::string& code, const std::string& message) {
    all_.push_back({code, grid_, message});
  }
  void warn(const std::string& code, const std::string& message) {
    all_.push_back({code, grid_, message, /*isFault=*/false});
  }

 private:
  std::vector<LintFinding>& all_;
  std::string grid_;
};

// Values

/// Extremes of the values of a grid, and its values that are no numbers.
struct Values {
  double least = std::numeric_limits<double>::infinity();  ///< of active voxels
  double most = -std::numeric_limits<double>::infinity();
  std::uint64_t notFinite = 0;  ///< active or not
  std::optional<Coord> first;   ///< of these, the lowest

  void add(const Values& other) {
    least = std::min(least, other.least);
    most = std::max(most, other.most);
    notFinite += other.notFinite;
    if (other.first && (!first || *other.first < *first)) first = other.first;
  }

  void add(double value, bool active, std::uint64_t voxels, const Coord& at) {
    if (!std::isfinite(value)) {
      notFinite += voxels;
      if (!first || at < *first) first = at;
    } else if (active) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
};

/// A scalar itself. Of a vector: a component that is no number, else the largest component.
template <class Value>
double scalarOf(const Value& value) {
  if constexpr (openvdb::VecTraits<Value>::IsVec) {
    double most = 0;
    for (int i = 0; i < openvdb::VecTraits<Value>::Size; ++i) {
      const auto component = std::abs(static_cast<double>(value[i]));
      if (!std::isfinite(component)) return component;
      most = std::max(most, component);
    }
    return most;
  } else {
    return static_cast<double>(value);
  }
}

template <class Leaf>
Values valuesOfLeaf(const Leaf& leaf) {
  Values found;
  const LeafValues<Leaf> values(leaf);
  for (Index offset = 0; offset < Leaf::SIZE; ++offset)
    found.add(scalarOf(values[offset]), leaf.isValueOn(offset), 1,
              leaf.offsetToGlobalCoord(offset));
  return found;
}

template <class Tree>
Values valuesOf(const Tree& tree) {
  std::vector<const typename Tree::LeafNodeType*> leaves;
  leaves.reserve(tree.leafCount());
  tree.getNodes(leaves);
  constexpr std::size_t kGrain = 256;
  std::vector<Values> parts((leaves.size() + kGrain - 1) / kGrain);
  parallelForEach(parts.size(), 1, [&](std::size_t i) {
    const std::size_t end = std::min(leaves.size(), (i + 1) * kGrain);
    for (std::size_t k = i * kGrain; k < end; ++k) parts[i].add(valuesOfLeaf(*leaves[k]));
  });
  Values all;
  for (const Values& part : parts) all.add(part);
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    all.add(scalarOf(*tile), tile.isValueOn(), tile.getVoxelCount(), tile.getCoord());
  return all;
}

std::string at(const Coord& voxel) {
  std::ostringstream text;
  text << '(' << voxel.x() << ' ' << voxel.y() << ' ' << voxel.z() << ')';
  return text.str();
}

template <class T>
std::string numberText(const T& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

bool isFog(const GridBase& grid) {
  return grid.getGridClass() == openvdb::GRID_FOG_VOLUME ||
         (grid.getGridClass() == openvdb::GRID_UNKNOWN && grid.getName() == "density");
}

/// The options that vox recorded; none if the grid is of another program, or damaged.
VolumeOptions recordedVolume(const GridBase& grid) {
  const auto text = grid[kOptionsMetadata];
  if (!text) return {};
  try {
    return parseOptionText(text->str()).options.volume;
  } catch (const InputError&) {
    return {};
  }
}

/// The width inside that vox recorded, in voxels, if that outside is another one.
std::optional<double> recordedInside(const GridBase& grid) {
  const auto band = recordedVolume(grid).band;
  if (band && !band->isSymmetric()) return band->in;
  return std::nullopt;
}

/// Whether values of active voxels lie between -inside and the background, and all others are one
/// of these.
template <class Grid>
bool isBand(const Grid& grid, double inside) {
  const double background = scalarOf(grid.background());
  constexpr double kRounding = 1e-6, kHalfRounding = 1.0 / 1024;
  const double slack = inside * (grid.saveFloatAsHalf() ? kHalfRounding : kRounding);
  for (auto value = grid.cbeginValueAll(); value; ++value) {
    const double v = scalarOf(*value);
    const bool fits = value.isValueOn() ? -inside - slack <= v && v <= background
                                        : v == background || std::abs(v + inside) <= slack;
    if (!fits) return false;
  }
  return true;
}

/// What the checks of OpenVDB find wrong with a level set. The last two of them want the same width
/// on both sides; a band that vox made with two widths is held against these. Left out is the check
/// that a band has 3 voxels or more on each side.
template <class Grid>
std::string wrongInBand(const Grid& grid) {
  openvdb::tools::CheckLevelSet<Grid> checks(grid);
  std::string wrong = checks.checkTransform();
  if (wrong.empty()) wrong = checks.checkTiles();
  if (wrong.empty()) wrong = checks.checkFinite();
  if (!wrong.empty()) return wrong;
  wrong = checks.checkRange();
  if (wrong.empty()) wrong = checks.checkInactiveValues();
  const auto inside = recordedInside(grid);
  return inside && isBand(grid, *inside * grid.voxelSize()[0]) ? std::string() : wrong;
}

/// What is wrong with a level set; empty: nothing. The last check of OpenVDB, of the gradient, is
/// left out: it reports exact distances where two parts of the surface are equally near.
/// @param thin  it has hardly any inside: signs, which whole voxels decide, may be wrong there
template <class Grid>
std::string wrongInLevelSet(const Grid& grid, bool thin) {
  const std::string wrong = wrongInBand(grid);
  if (!wrong.empty() || thin) return wrong;
  const SteepPairs steep = steepPairs(grid);
  if (steep.count == 0) return {};
  return "distances of " + numberText(steep.count) + (steep.count == 1 ? " pair" : " pairs") +
         " of neighbouring voxels differ by more than their distance, the first at " +
         at(steep.first);
}

/// Blender leaves out densities that are not larger.
constexpr double kVisible = 0.001F;

template <class Grid>
void lintScalars(const Grid& grid, const Values& values, LintFindings& findings) {
  const double background = scalarOf(grid.background());
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
    if constexpr (std::is_floating_point_v<typename Grid::ValueType>) {
      // A sheet one voxel thick is deeper.
      const bool thin = std::isfinite(values.least) && values.least > -grid.voxelSize()[0] / 4;
      const std::string wrong = wrongInLevelSet(grid, thin);
      if (!wrong.empty()) findings.add("level-set", "is no valid level set: " + wrong);
      constexpr double kLeastWidth = 3, kRounding = 1e-4;  // voxels
      const double width = background / grid.voxelSize()[0];
      if (width > 0 && width < kLeastWidth - kRounding)
        findings.warn("narrow-band", "holds distances up to " + numberText(width) +
                                         (width == 1 ? " voxel" : " voxels") +
                                         " outside: tools of OpenVDB, and programs that move or "
                                         "resample level sets, want 3; use a wider --band");
      if (thin)
        findings.warn("no-inside",
                      "is a level set with hardly any inside: what it shows is thinner than a "
                      "voxel; use smaller voxels");
    }
    if (grid.getName() == "density")
      findings.add("sdf-as-fog",
                   "is a level set by the name of a fog volume: it will be shown as a cloud "
                   "around the surface; name it surface");
    return;
  }
  if (!isFog(grid)) return;
  if (background != 0)
    findings.add("background", "has background " + numberText(background) +
                                   ", not 0: the space around will be filled with it");
  if (values.least < 0 && background > 0)
    findings.add("sdf-as-fog",
                 "looks like signed distances, but is a fog volume: make it a level set");
  if (grid.activeVoxelCount() > 0 && values.most <= kVisible)
    findings.add("invisible", "has no value above 0.001: Blender will show nothing");
}

/// Visits every value.
void lintValues(const GridBase& grid, LintFindings& findings) {
  using Valued = ComparedTypes::Remove<openvdb::BoolGrid, openvdb::MaskGrid>;
  grid.apply<Valued>([&](const auto& typed) {
    using Grid = std::decay_t<decltype(typed)>;
    const Values values = valuesOf(typed.tree());
    if (values.notFinite > 0)
      findings.add("not-finite", numberText(values.notFinite) +
                                     " voxels hold NaN or infinity, the first at " +
                                     at(*values.first) + ": what is shown is undefined");
    if (!std::isfinite(scalarOf(typed.background())))
      findings.add("background", "has a background that is not a number");
    if constexpr (!openvdb::VecTraits<typename Grid::ValueType>::IsVec)
      lintScalars(typed, values, findings);
  });
}

// The rest of a grid

void lintVoxels(const GridBase& grid, LintFindings& findings) {
  const std::uint64_t active = grid.activeVoxelCount();
  if (active == 0)
    findings.add("empty", "has no active voxels: there is nothing to show");
  else if (grid.constBaseTree().leafCount() == 0)
    findings.add("tiles-only",
                 "has tiles but no leaf: Blender's Cycles will show nothing; voxelize the tiles");
  // Blender's EEVEE keeps a grid as one texture; Cycles and Houdini have no such limit.
  constexpr int kMostAlongAxis = 2048;
  const Coord size = grid.evalActiveVoxelBoundingBox().dim();
  const int longest = std::max({size.x(), size.y(), size.z()});
  if (active > 0 && longest > kMostAlongAxis && recordedVolume(grid).target != Target::kHoudini)
    findings.warn("eevee", "is " + numberText(longest) +
                               " voxels long: EEVEE of Blender shows at most 2048 along an axis on "
                               "many graphics cards; Cycles has no such limit");
  const auto said = grid.getMetadata<openvdb::Int64Metadata>("vox_active_voxels");
  // Other grids hold other voxels: the inside, or a band.
  if (said && grid.isType<openvdb::MaskGrid>() &&
      static_cast<std::uint64_t>(said->value()) != active)
    findings.add("count", "has " + numberText(active) + " active voxels, but was made with " +
                              numberText(said->value()) + ": something has changed it since");
}

void lintTransform(const GridBase& grid, LintFindings& findings) {
  const openvdb::math::Transform& transform = grid.transform();
  if (!transform.isLinear())
    findings.add("frustum", "has a " + transform.mapType() +
                                ", not a linear transform: Blender will not show it; resample it");
}

void lintName(const GridBase& grid, LintFindings& findings) {
  const std::string name = grid.getName();
  if (name.empty()) findings.add("name", "has no name: viewers find grids by theirs");
  const bool odd = std::any_of(name.begin(), name.end(), [](char c) {
    return !(std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-');
  });
  if (odd)
    findings.add("name",
                 "has characters in its name that attributes of Houdini cannot have; use letters, "
                 "digits and _");
  const bool forHoudini = grid["vox_version"] != nullptr;  // vox writes that name only for Houdini
  if (name == "N" && !forHoudini && grid.valueType().starts_with("vec3"))
    findings.add("name", "is a vector grid by the name of Blender's own normals; name it normal");
}

void lint(const GridBase& grid, std::vector<LintFinding>& all, const std::string& name) {
  LintFindings findings(all, name);
  lintName(grid, findings);
  lintTransform(grid, findings);
  lintVoxels(grid, findings);
  lintValues(grid, findings);
}

}  // namespace

const std::vector<LintRule>& lintRules() {
  static const std::vector<LintRule> rules = {
      {"no-density", "no grid named density, the one Blender renders by default, nor parts of it"},
      {"background", "a fog volume whose background is not 0"},
      {"not-finite", "NaN or infinite values"},
      {"level-set", "a level set that is not valid, or steeper than distances are"},
      {"sdf-as-fog", "signed distances that viewers show as fog"},
      {"invisible", "a fog volume without values above 0.001"},
      {"tiles-only", "tiles but no leaves"},
      {"empty", "no active voxels"},
      {"frustum", "a transform that is not linear"},
      {"name", "a name that is missing, used twice, or not for Blender or Houdini"},
      {"creator", "a creator that starts with Houdini: Blender turns the object then"},
      {"narrow-band", "warning: a level set with distances to less than 3 voxels outside"},
      {"no-inside", "warning: a level set with hardly any inside"},
      {"eevee", "warning: more than 2048 voxels along an axis"},
      {"count", "not the number of voxels that vox convert recorded"},
  };
  return rules;
}

std::vector<LintFinding> lintGrid(const GridBase& grid) {
  std::vector<LintFinding> findings;
  lint(grid, findings, grid.getName());
  return findings;
}

std::vector<LintFinding> lintVdb(const std::filesystem::path& file) {
  const VdbFile vdb = readVdb(file);
  std::vector<LintFinding> all;
  LintFindings findings(all, "");
  std::set<std::string> names;
  for (const NamedGrid& named : vdb.grids)
    if (!names.insert(named.grid->getName()).second)
      findings.add("name", "there are several grids named '" + named.grid->getName() +
                               "': viewers take one of them");
  const bool isSplit = std::any_of(vdb.grids.begin(), vdb.grids.end(), [](const NamedGrid& named) {
    return (*named.grid)[kPartNameMetadata] != nullptr;
  });
  if (!names.contains("density") && !isSplit)
    findings.add("no-density",
                 "there is no grid named density: Blender will show nothing until a material asks "
                 "for another; add density to --grids, or pass --ignore no-density");
  const auto creator = (*vdb.metadata)["creator"];
  if (creator && creator->str().starts_with("Houdini"))
    findings.add("creator", "the creator is Houdini: Blender will turn the object to Z up");
  for (const NamedGrid& named : vdb.grids) lint(*named.grid, all, named.name);
  return all;
}

}  // namespace vox
