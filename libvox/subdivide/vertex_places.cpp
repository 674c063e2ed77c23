// From vertices of a refined mesh back to places on the base mesh, step by step.

#include "libvox/subdivide/vertex_places.h"

#include "libvox/core/parallel.h"
#include "libvox/subdivide/strip.h"

#include <cmath>

namespace vox {
namespace {

constexpr std::uint8_t kFullTurn = 4;

/// The first step: a vertex for each corner, and two for each boundary edge of an extended mesh.
std::vector<VertexPlace> firstPlaces(const SubdivisionLevel& base) {
  std::vector<VertexPlace> places;
  for (Index c = 0; c < base.mesh.cornerCount(); ++c) places.push_back({c, 0.5F, 0.5F});
  if (base.boundary != BoundaryStage::kExtend) return places;
  for (const Index c : boundaryCorners(base.adjacency)) {
    places.push_back({c, 0.5F, 0, 0, true});
    places.push_back({nextCorner(base.mesh, base.adjacency, c), 0, 0.5F, 3, true});
  }
  return places;
}

/// Turns of the corners at an interior vertex, whose number is that of a corner of it.
void turnAround(const SubdivisionLevel& level, Index vertex, std::uint8_t turn,
                std::vector<std::uint8_t>& turns) {
  turns[vertex] = turn;
  unsigned next = turn;
  Index c = nextAroundVertex(level.mesh, level.adjacency, vertex);
  for (; c != kNone && c != vertex; c = nextAroundVertex(level.mesh, level.adjacency, c))
    turns[c] = static_cast<std::uint8_t>(++next % kFullTurn);
  if (c == vertex) return;
  next = turn + kFullTurn;  // a free boundary ends the walk, so another goes the other way
  c = previousAroundVertex(level.mesh, level.adjacency, vertex);
  for (; c != kNone; c = previousAroundVertex(level.mesh, level.adjacency, c))
    turns[c] = static_cast<std::uint8_t>(--next % kFullTurn);
}

}  // namespace

std::vector<std::uint8_t> cornerTurns(const SubdivisionLevel& level,
                                      const std::vector<VertexPlace>& places) {
  const PolygonMesh& mesh = level.mesh;
  std::vector<std::uint8_t> turns(mesh.cornerCount(), 0);
  parallelForEach(mesh.pointCount(), kElementsPerTask, [&](Index v) {
    if (!places[v].onBoundary) turnAround(level, v, places[v].turn, turns);
  });
  parallelForEach(mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    const VertexPlace& place = places[mesh.faceVertices[c]];
    if (!place.onBoundary) return;
    const unsigned more = level.adjacency.twin[c] == kNone ? 0 : 1;
    turns[c] = static_cast<std::uint8_t>((place.turn + more) % kFullTurn);
  });
  return turns;
}

std::vector<VertexPlace> nextPlaces(const SubdivisionLevel& level,
                                    const std::vector<VertexPlace>& places, int k) {
  if (places.empty()) return firstPlaces(level);
  const std::vector<std::uint8_t> turns = cornerTurns(level, places);
  const auto step = static_cast<float>(std::ldexp(1.0, -k - 1));
  std::vector<VertexPlace> next(level.mesh.cornerCount());
  parallelForEach(level.mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    VertexPlace place = places[level.mesh.faceVertices[c]];
    Vec2f move = turnedAxis(turns[c]);
    if (!place.onBoundary) {
      move += turnedAxis(turns[c] + 1U);
      place.turn = turns[c];
    } else if (level.adjacency.twin[c] != kNone) {
      move = -turnedAxis(place.turn);
    }
    place.u += step * move.x();
    place.v += step * move.y();
    next[c] = place;
  });
  return next;
}

}  // namespace vox
