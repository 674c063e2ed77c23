#pragma once

#include "libvox/subdivide/extraordinary.h"
#include "libvox/subdivide/face_shape.h"

#include <deque>

namespace vox {

/// The levels of an extraordinary face from 2 on, each made when somebody asks for it; O(n) per
/// level. Corners whose surroundings are not known at the first level have none below.
class ExtraordinaryLevels {
 public:
  struct Level {
    ExtraordinaryFace face;
    FaceShape shape;  ///< of its polygon
  };

  /// Begins again with level 2.
  void start(ExtraordinaryFace face);

  /// l levels below the first; valid until start.
  /// @throws LimitError  l is beyond any range
  const Level& level(int l);

  /// One step at corner i of level l.
  VertexSplit split(int l, std::size_t i) {
    const ExtraordinaryFace& next = level(l + 1).face;
    return level(l).face.splitAt(next.inner, i);
  }

 private:
  void addLevel(ExtraordinaryFace face);

  std::deque<Level> levels_;  // references stay valid
  FaceImages images_;
};

}  // namespace vox
