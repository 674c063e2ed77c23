// Faces as cyclic linked lists of corners, and a work list of the vertices to check.

#include "libvox/prepare/chord.h"

#include "libvox/core/parallel.h"

#include <utility>

namespace vox {
namespace {

class Chording {
 public:
  Chording(const PolygonMesh& mesh, const Adjacency& joints)
      : mesh_(mesh),
        joints_(joints),
        twin_(joints.twin),
        next_(mesh.cornerCount()),
        previous_(mesh.cornerCount()),
        alive_(mesh.cornerCount(), true),
        faceSize_(mesh.faceCount()),
        cornerAt_(mesh.pointCount(), kNone),
        valence_(mesh.pointCount(), 0) {
    for (Index f = 0; f < mesh.faceCount(); ++f) faceSize_[f] = mesh.faceSize(f);
    for (Index c = 0; c < mesh.cornerCount(); ++c) {
      next_[c] = nextCorner(mesh, joints, c);
      previous_[c] = previousCorner(mesh, joints, c);
      cornerAt_[vertexOf(c)] = c;
      ++valence_[vertexOf(c)];
    }
  }

  ChordResult run() {
    for (Index v = mesh_.pointCount(); v-- > 0;)
      if (isInteriorPair(v)) work_.push_back(v);
    while (!work_.empty()) {
      const Index v = work_.back();
      work_.pop_back();
      if (isInteriorPair(v)) chord(v);
    }
    collectFaces();
    return std::move(result_);
  }

 private:
  Index vertexOf(Index c) const { return mesh_.faceVertices[c]; }

  bool isInteriorPair(Index v) const {
    if (valence_[v] != 2) return false;
    const Index c = cornerAt_[v];
    return twin_[c] != kNone && twin_[previous_[c]] != kNone;
  }

  /// The corner at v of the face that has edge e.
  Index cornerOn(Index e, Index v) const { return vertexOf(e) == v ? e : next_[e]; }

  void chord(Index v) {
    const Index a = cornerAt_[v];
    const Index b = cornerOn(twin_[a], v);
    result_.chordedVertices.push_back(v);
    valence_[v] = 0;
    const Index u = vertexOf(previous_[a]);
    const Index w = vertexOf(next_[a]);
    unlink(a);
    unlink(b);
    join(previous_[a], previous_[b]);
    closeIfTwoCornered(previous_[a]);
    closeIfTwoCornered(previous_[b]);
    work_.push_back(w);
    work_.push_back(u);
  }

  void unlink(Index c) {
    alive_[c] = false;
    next_[previous_[c]] = next_[c];
    previous_[next_[c]] = previous_[c];
    --faceSize_[joints_.cornerFace[c]];
  }

  void join(Index a, Index b) {
    if (a != kNone) twin_[a] = b;
    if (b != kNone) twin_[b] = a;
  }

  /// If the face of corner p has two corners left, drops it and joins its two neighbours.
  void closeIfTwoCornered(Index p) {
    const Index f = joints_.cornerFace[p];
    if (faceSize_[f] != 2) return;
    const Index q = next_[p];
    alive_[p] = alive_[q] = false;
    result_.collapsedFaces.push_back(f);
    const Index left = twin_[p];
    const Index right = twin_[q];
    if (left == q) result_.vanishedComponents.push_back(f);
    const Index rest = left == q ? kNone : left != kNone ? left : right;
    if (left != q) join(left, right);
    leave(vertexOf(p), rest);
    leave(vertexOf(q), rest);
  }

  /// Notes that vertex v has lost a corner. `rest` is an edge at v that is still alive, or kNone.
  void leave(Index v, Index rest) {
    --valence_[v];
    cornerAt_[v] = rest == kNone ? kNone : cornerOn(rest, v);
    work_.push_back(v);
  }

  void collectFaces() {
    result_.mesh.points = mesh_.points;
    std::vector<Index> face;
    for (Index f = 0; f < mesh_.faceCount(); ++f) {
      face.clear();
      for (Index c = mesh_.faceOffsets[f]; c < mesh_.faceOffsets[f + 1]; ++c)
        if (alive_[c]) face.push_back(vertexOf(c));
      if (face.empty()) continue;
      result_.mesh.addFace(face);
      result_.faceOrigin.push_back(f);
    }
  }

  const PolygonMesh& mesh_;
  const Adjacency& joints_;
  std::vector<Index> twin_;
  std::vector<Index> next_;
  std::vector<Index> previous_;
  std::vector<bool> alive_;
  std::vector<Index> faceSize_;
  std::vector<Index> cornerAt_;  // an alive corner of each vertex, or kNone
  std::vector<Index> valence_;   // number of alive corners of each vertex
  std::vector<Index> work_;
  ChordResult result_;
};

}  // namespace

bool hasInteriorPair(const PolygonMesh& mesh, const Adjacency& joints) {
  const Index corners = mesh.cornerCount();
  return lowestWhere(corners, kElementsPerTask, [&](Index c) {
           const Index out = joints.twin[c];
           const Index in = joints.twin[previousCorner(mesh, joints, c)];
           return out != kNone && in != kNone && joints.cornerFace[out] == joints.cornerFace[in];
         }) < corners;
}

ChordResult chordInteriorPairs(const PolygonMesh& mesh, const Adjacency& joints) {
  return Chording(mesh, joints).run();
}

void openInteriorPairs(const PolygonMesh& mesh, Adjacency& joints) {
  std::vector<Index> valence(mesh.pointCount(), 0);
  for (const Index v : mesh.faceVertices) ++valence[v];
  std::vector<Index> opened;
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    if (valence[mesh.faceVertices[c]] == 2 && joints.twin[c] != kNone &&
        joints.twin[previousCorner(mesh, joints, c)] != kNone)
      opened.push_back(c);
  for (const Index c : opened)
    for (const Index e : {c, previousCorner(mesh, joints, c)}) {
      if (joints.twin[e] != kNone) joints.twin[joints.twin[e]] = kNone;
      joints.twin[e] = kNone;
    }
}

}  // namespace vox
