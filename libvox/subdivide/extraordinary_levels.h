#pragma once

#include "libvox/subdivide/extraordinary.h"
#include "libvox/subdivide/face_shape.h"

#include <deque>

namespace vox {

/// An extraordinary face of level 2 and its images at the levels below. A level is made when it is
/// first used; cost O(n) for each. A corner whose surroundings are not set at level 2 has none at
/// the levels below. One object per thread.
class ExtraordinaryLevels {
 public:
  struct Level {
    ExtraordinaryFace face;
    FaceShape shape;  ///< of the polygon
  };

  /// Replaces the face of level 2.
  void start(ExtraordinaryFace face);

  /// The face of level 2 + l. The reference is valid until start.
  /// @throws LimitError  there are too many levels (requireLevelInRange)
  const Level& level(int l);

  /// One step at corner i of level(l).
  VertexSplit split(int l, std::size_t i) {
    const ExtraordinaryFace& next = level(l + 1).face;
    return level(l).face.splitAt(next.inner, i);
  }

 private:
  void addLevel(ExtraordinaryFace face);

  std::deque<Level> levels_;  // a deque: references stay valid
  FaceImages images_;
};

}  // namespace vox
