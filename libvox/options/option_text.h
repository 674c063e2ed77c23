#pragma once

#include "libvox/options/convert_options.h"

#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// Metadata of grids: the options of the conversion, as optionText() writes them.
inline constexpr const char* kOptionsMetadata = "vox_options";

/// The options that change the voxels and are set, as words: "dim=256 boundary=free half". Lists of
/// vertices and edges are only counted. Not written: grids, strict, separation, compression, and
/// what does not change the grids.
std::string optionText(const ConvertOptions& options);

/// Options read from such a text.
struct RecordedOptions {
  ConvertOptions options;
  /// The options that are lists of vertices or edges, by their words ("corner-vertices"). The text
  /// only counts what is in them.
  std::vector<std::string> lists;
};

/// Reads what optionText() writes: of all numbers that stand in the text themselves, the same bits.
/// @throws InputError  the text has an unknown option or a value that the option cannot have; the
///   message quotes it
RecordedOptions parseOptionText(std::string_view text);

/// Metadata of grids: what the active voxels guarantee, "26-separating".
inline constexpr const char* kGuaranteeMetadata = "vox_guarantee";
std::string guaranteeText(Separation separation);
/// @throws InputError  the text is no such guarantee; the message quotes it
Separation parseGuarantee(std::string_view text);

}  // namespace vox
