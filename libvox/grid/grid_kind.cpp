// Names of the output grids.

#include "libvox/grid/grid_kind.h"

#include <array>

namespace vox {
namespace {

constexpr std::array kAll = {GridKind::kDensity, GridKind::kMask, GridKind::kSurface,
                             GridKind::kNormal, GridKind::kColor};

}  // namespace

std::string gridName(GridKind kind) {
  switch (kind) {
    case GridKind::kDensity:
      return "density";
    case GridKind::kMask:
      return "mask";
    case GridKind::kNormal:
      return "normal";
    case GridKind::kColor:
      return "color";
    case GridKind::kSurface:
      return "surface";
  }
  return {};
}

std::optional<GridKind> gridNamed(std::string_view name) {
  for (const GridKind kind : kAll)
    if (gridName(kind) == name) return kind;
  return std::nullopt;
}

std::string allGridNames() {
  std::string names;
  for (const GridKind kind : kAll) names += (names.empty() ? "" : ", ") + gridName(kind);
  return names;
}

}  // namespace vox
