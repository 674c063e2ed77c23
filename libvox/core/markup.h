#pragma once

#include <string>
#include <string_view>

namespace vox {

/// Any bytes as the text of an element of XML or HTML. Characters with a meaning become entities.
/// What such a text cannot hold (control characters, bytes that are no UTF-8) becomes U+FFFD.
std::string escaped(std::string_view text);

/// The same as the value of an attribute, in double quotes: line ends and tabs stay what they are.
std::string escapedValue(std::string_view text);

}  // namespace vox
