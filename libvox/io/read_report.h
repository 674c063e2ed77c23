#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vox {

/// What the readers accept though the definition of the format does not have it.
enum class Oddity {
  kShortFace,          ///< a face of fewer than 3 corners, dropped
  kUndefinedPoint,     ///< a vertex at NaN or infinity without a face; its position becomes 0
  kUndefinedFacet,     ///< an STL facet with a coordinate that is NaN or infinite, dropped
  kFreeForm,           ///< a curve or surface beside the polygons, ignored
  kTrailingBytes,      ///< content after the last element, ignored
  kBrightColor,        ///< a colour value above full brightness, clamped
  kDamagedColors,      ///< a line of colours that cannot be read, ignored
  kNoSurface,          ///< glTF points or lines, ignored
  kPose,               ///< a glTF skin or morph target; the mesh is read as it is without
  kUndefinedTexcoord,  ///< a texture coordinate at NaN or infinity, or one that does not exist
  // Understood without loss:
  kForeignColor,   ///< a colour by a name, of a type or at a place that only some programs use
  kGluedKeyword,   ///< a keyword followed by its number without a blank: OFF8
  kBrokenFace,     ///< an OFF face over several lines
  kGluedComment,   ///< a comment right after an index or number: 7#
  kBackslashName,  ///< a name that ends with a backslash, which is no continuation
};
inline constexpr std::size_t kOddityCount = 15;

/// The oddities of a mesh file, by kind.
struct ReadReport {
  static constexpr std::uint64_t kNoElement = ~std::uint64_t{0};

  struct Count {
    std::uint64_t count = 0;
    std::size_t line = 0;                ///< of the first; 0: the file is binary
    std::uint64_t element = kNoElement;  ///< number of the first, from 0
  };
  std::string file;
  std::vector<std::string> materialFiles{};     ///< as the file names them
  std::vector<std::string> companions{};        ///< paths of the other files that were read
  std::vector<std::string> materialProblems{};  ///< what is wrong with them, one line each
  std::array<Count, kOddityCount> counts{};

  /// Notes an oddity. The first of each kind keeps its place.
  void add(Oddity kind, std::size_t line, std::uint64_t element = kNoElement,
           std::uint64_t count = 1);

  /// Adds what was found in a later part of the file, which numbers its lines from 1.
  /// @param linesBefore  lines before the part
  void append(const ReadReport& part, std::size_t linesBefore = 0);

  const Count& operator[](Oddity kind) const { return counts[static_cast<std::size_t>(kind)]; }
};

/// What was lost, in one line: "dropped 2 faces of fewer than 3 corners (the first on line 16)".
/// Empty if nothing was.
std::string lossText(const ReadReport& report);

/// The first oddity, lost or not: "FILE:LINE: a face over several lines". Empty if there is none.
std::string firstOddity(const ReadReport& report);

}  // namespace vox
