#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// A page of HTML that needs no other file: the style sheet and the script of the viewer are in it.
/// @param title  plain text
/// @param body   HTML
std::string page(std::string_view title, std::string_view body);

/// The command that makes the same again, as one line for a POSIX shell.
std::string shellLine(const std::vector<std::string>& words);

// report.css and viewer.js.
extern const std::string_view kReportStyle;
extern const std::string_view kViewerScript;

}  // namespace vox
