#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

namespace vox {

/// `text` between quotes, fit for a one-line message: at most 40 characters, unprintable ones as ?.
std::string quote(std::string_view text);

/// Cuts a text into lines and blank-separated tokens, converts numbers independently of the locale,
/// and reports errors as "FILE:LINE: ...". A line ends with LF, CRLF or CR; a byte order mark at
/// the start is skipped. Keeps a view: the text must outlive the scanner.
class TextScanner {
 public:
  struct Rules {
    bool hashComments = false;   ///< # at the start of a token: a comment up to the end of the line
    bool continuations = false;  ///< a backslash at the end of a line joins it with the next
  };

  TextScanner(std::string_view text, std::string fileName, Rules rules);

  /// Next token of the current line; empty at its end.
  std::string_view token();

  /// Next token of this or any later line; empty at the end of the text.
  std::string_view tokenOnAnyLine();

  /// Skips to the start of the next line; false if the text ends first.
  bool nextLine();

  /// What has not been read yet.
  std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

  /// Line of the last token, from 1.
  std::size_t line() const { return line_; }

  /// A finite number; a leading + is fine, numbers too small for a double become 0.
  double number(std::string_view token) const;

  /// A number of at most kMaxCoordinate in size.
  double coordinate(std::string_view token) const;

  /// A whole number.
  std::int64_t integer(std::string_view token) const;

  [[noreturn]] void fail(const std::string& what) const { failAt(line_, what); }
  [[noreturn]] void failAt(std::size_t line, const std::string& what) const;

 private:
  static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static std::string_view withoutPlus(std::string_view token);
  bool endsToken(char c) const { return endsToken_[static_cast<unsigned char>(c)]; }
  bool continuesHere() const;
  void skipLineEnd();
  double unusualNumber(std::string_view token) const;

  std::string fileName_;
  Rules rules_;
  std::array<bool, 256> endsToken_{};
  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
};

// Inline: called once per number of the file.

inline std::string_view TextScanner::withoutPlus(std::string_view token) {
  const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
  return plus ? token.substr(1) : token;
}

inline double TextScanner::number(std::string_view token) const {
  const std::string_view text = withoutPlus(token);
  const char* const textEnd = text.data() + text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), textEnd, value);
  if (error == std::errc{} && stop == textEnd && std::isfinite(value)) [[likely]]
    return value;
  return unusualNumber(token);
}

inline std::string_view TextScanner::token() {
  while (at_ != end_ && (isBlank(*at_) || continuesHere())) {
    if (*at_++ == '\\') skipLineEnd();
  }
  if (at_ != end_ && *at_ == '#' && rules_.hashComments) return {};
  const char* const begin = at_;
  while (at_ != end_ && (!endsToken(*at_) || (*at_ == '\\' && !continuesHere()))) ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

}  // namespace vox
