// The frame of a report.

#include "libvox/report/page.h"

#include "libvox/core/markup.h"
#include "libvox/core/version.h"
#include "libvox/report/html.h"

#include <algorithm>
#include <cctype>

namespace vox {

std::string page(std::string_view title, std::string_view body) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      // Nothing is loaded from elsewhere, whatever a report holds.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>";
  html += escaped(title);
  html += "</title>\n<style>\n";
  html += kReportStyle;
  html += "</style>\n</head>\n<body>\n";
  html += body;
  html += "<footer>Made by vox ";
  html += version();
  html += ".</footer>\n<script>\n";
  html += kViewerScript;
  html += "</script>\n</body>\n</html>\n";
  return html;
}

std::string shellLine(const std::vector<std::string>& words) {
  constexpr std::string_view kPlain = "-_./,=:+%@#";
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    const bool isPlain =
        !word.empty() && word.front() != '#' &&
        std::all_of(word.begin(), word.end(), [&](unsigned char c) {
          return std::isalnum(c) != 0 || kPlain.find(static_cast<char>(c)) != kPlain.npos;
        });
    if (isPlain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace vox
