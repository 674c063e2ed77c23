#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vox::app {

/// The candidate nearest to a mistyped word, by edit distance. "" if none is near: near means at
/// most two edits, or at most a third of the letters of the word.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace vox::app
