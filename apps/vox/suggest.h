#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vox::app {

/// The candidate nearest to a mistyped word (edit distance), or "" when none is near: more than a
/// third of its letters, and at least two, would have to change.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace vox::app
