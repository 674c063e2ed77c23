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

/// `text` in quotes for a one-line message: at most 40 characters of it, unprintable ones as '?'.
std::string quote(std::string_view text);

/// Splits a text into lines and blank-separated tokens, and converts numbers independently of the
/// locale. Errors are InputErrors "FILE:LINE: ...". A line ends with LF, CRLF or CR; a byte order
/// mark at the start is skipped, UTF-16 is refused. The text must outlive the scanner.
class TextScanner {
 public:
  struct Rules {
    bool hashComments = false;   ///< a # begins a comment, but not that of 1.#INF
    bool continuations = false;  ///< a backslash at the end of a line joins it with the next line
  };

  /// @throws InputError  the text is UTF-16
  TextScanner(std::string_view text, std::string fileName, Rules rules);

  /// Scans a part of a text.
  /// @param line  number of the line that the part begins with
  TextScanner(std::string_view part, std::string fileName, Rules rules, std::size_t line);

  /// Next token of the current line; empty at the end of the line.
  std::string_view token();

  /// Next token of this or any later line; empty at the end of the text.
  std::string_view tokenOnAnyLine();

  /// Skips to the start of the next line; returns false if there is none.
  bool nextLine();

  /// What is left of the current line, comments included; a backslash at its end joins nothing.
  std::string_view restOfLine();

  /// The text that has not been read yet.
  std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

  /// Number of the current line, from 1.
  std::size_t line() const { return line_; }

  /// Comments that follow a token without a blank, and the line of the first of them.
  std::uint64_t gluedComments() const { return gluedComments_; }
  std::size_t lineOfGluedComment() const { return lineOfGluedComment_; }

  /// The finite number of a token. A leading + is accepted; numbers too small for a double become
  /// 0.
  /// @throws InputError  the token is none
  double number(std::string_view token) const;

  /// The number of a token; or NaN, if the token is a spelling of NaN or infinity.
  /// @throws InputError  the token is none
  double numberOrNan(std::string_view token) const;

  /// The same, at most kMaxCoordinate in size.
  /// @throws InputError  the token is none
  double coordinate(std::string_view token) const;

  /// The whole number of a token.
  /// @throws InputError  the token is none
  std::int64_t integer(std::string_view token) const;

  /// @throws InputError  always
  [[noreturn]] void fail(const std::string& what) const { failAt(line_, what); }
  [[noreturn]] void failAt(std::size_t line, const std::string& what) const;

 private:
  static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static std::string_view withoutPlus(std::string_view token);
  bool endsToken(char c) const { return endsToken_[static_cast<unsigned char>(c)]; }
  bool continuesHere() const;
  bool isInToken() const;
  void skipLineEnd();
  double unusualNumber(std::string_view token) const;
  std::int64_t unusualInteger(std::string_view token) const;

  std::string fileName_;
  Rules rules_;
  std::array<bool, 256> endsToken_{};
  const char* at_;
  const char* end_;
  std::size_t line_;
  std::uint64_t gluedComments_ = 0;
  std::size_t lineOfGluedComment_ = 0;
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

inline std::int64_t TextScanner::integer(std::string_view token) const {
  constexpr std::size_t kSafeDigits = 18;
  std::int64_t value = 0;
  std::size_t digits = 0;
  for (; digits < token.size() && token[digits] >= '0' && token[digits] <= '9'; ++digits) {
    if (digits == kSafeDigits) return unusualInteger(token);
    value = 10 * value + (token[digits] - '0');
  }
  return digits > 0 && digits == token.size() ? value : unusualInteger(token);
}

inline std::string_view TextScanner::token() {
  while (at_ != end_ && (isBlank(*at_) || continuesHere())) {
    if (*at_++ == '\\') skipLineEnd();
  }
  if (at_ != end_ && *at_ == '#' && rules_.hashComments) return {};
  const char* const begin = at_;
  while (at_ != end_ && (!endsToken(*at_) || isInToken())) ++at_;
  if (at_ != end_ && *at_ == '#' && gluedComments_++ == 0) lineOfGluedComment_ = line_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

}  // namespace vox
