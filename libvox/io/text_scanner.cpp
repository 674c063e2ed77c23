// Tokens and numbers of text formats.

#include "libvox/io/text_scanner.h"

#include "libvox/core/error.h"
#include "libvox/io/read_mesh.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vox {

namespace {

constexpr std::size_t kMaxQuoted = 40;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool isPrintable(char c) {
  return c >= 0x20 && c < 0x7f;
}
bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// True for the ends of 1.#INF, -1.#IND, 1.#QNAN and 1.#SNAN, as some C libraries spell them.
bool startsUndefined(std::string_view text) {
  const auto starts = [&](std::string_view word) { return text.starts_with(word); };
  return starts("#INF") || starts("#IND") || starts("#QNAN") || starts("#SNAN");
}

/// True for all spellings of NaN and infinity.
bool isUndefined(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  if (text.empty() || (isDigit(text[0]) && text.find('#') == text.npos)) return false;
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{}) return false;
  return stop == end ? !std::isfinite(value) : startsUndefined({stop, end});
}

/// UTF-16 with a byte order mark, or with a character of ASCII at the start.
bool isUtf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  return text.size() >= 2 &&
         ((text[0] == 0 && isPrintable(text[1])) || (text[1] == 0 && isPrintable(text[0])));
}

// Whether a decimal literal outside the range of doubles is too large, not too small: if the
// decimal exponent of its first nonzero digit is positive.
bool isTooLarge(std::string_view literal) {
  const std::size_t mantissaEnd = std::min(literal.find_first_of("eE"), literal.size());
  const std::string_view mantissa = literal.substr(0, mantissaEnd);
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return false;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());

  std::string_view digits = literal.substr(std::min(mantissaEnd + 1, literal.size()));
  if (digits.starts_with('+')) digits.remove_prefix(1);
  std::int64_t exponent = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
  if (parsed.ec == std::errc::result_out_of_range) return !digits.starts_with('-');

  const double place = static_cast<double>(point) - static_cast<double>(first);
  return static_cast<double>(exponent) + place > 0;
}

}  // namespace

std::string quote(std::string_view text) {
  const bool cut = text.size() > kMaxQuoted;
  std::string result(text.substr(0, kMaxQuoted));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return !isPrintable(c); }, '?');
  return "'" + result + (cut ? "...'" : "'");
}

TextScanner::TextScanner(std::string_view text, std::string fileName, Rules rules)
    : TextScanner(text, std::move(fileName), rules, 1) {
  if (text.starts_with(kByteOrderMark)) at_ += kByteOrderMark.size();
  if (isUtf16(rest())) fail("the text is UTF-16; save it as UTF-8 or ASCII");
}

TextScanner::TextScanner(std::string_view part, std::string fileName, Rules rules, std::size_t line)
    : fileName_(std::move(fileName)),
      rules_(rules),
      at_(part.data()),
      end_(at_ + part.size()),
      line_(line) {
  for (const char c : {' ', '\t', '\v', '\f', '\n', '\r'})
    endsToken_[static_cast<unsigned char>(c)] = true;
  endsToken_['#'] = rules.hashComments;
  endsToken_['\\'] = rules.continuations;
}

bool TextScanner::continuesHere() const {
  return rules_.continuations && *at_ == '\\' && at_ + 1 != end_ &&
         (at_[1] == '\n' || at_[1] == '\r');
}

/// True if a character that ends tokens elsewhere belongs to one here.
bool TextScanner::isInToken() const {
  if (*at_ == '\\') return !continuesHere();
  return *at_ == '#' && startsUndefined(rest());
}

std::string_view TextScanner::restOfLine() {
  const char* const begin = at_;
  while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

void TextScanner::skipLineEnd() {
  const bool crLf = *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n';
  at_ += crLf ? 2 : 1;
  if (at_ != end_) ++line_;  // the end of the text starts no new line
}

std::string_view TextScanner::tokenOnAnyLine() {
  do {
    const std::string_view found = token();
    if (!found.empty()) return found;
  } while (nextLine());
  return {};
}

bool TextScanner::nextLine() {
  bool inComment = false;
  while (at_ != end_) {
    if (*at_ == '\n' || *at_ == '\r') {
      skipLineEnd();
      return at_ != end_;
    }
    if (*at_ == '#') inComment = rules_.hashComments;
    const bool continues = !inComment && continuesHere();
    ++at_;
    if (continues) skipLineEnd();
  }
  return false;
}

double TextScanner::unusualNumber(std::string_view token) const {
  const std::string_view text = withoutPlus(token);
  const char* const textEnd = text.data() + text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), textEnd, value);

  if (text.empty() || stop != textEnd || error == std::errc::invalid_argument)
    fail("expected a number, found " + quote(token));
  const std::string_view literal = text.substr(text[0] == '-' ? 1 : 0);
  if (!isDigit(literal[0]) && literal[0] != '.') fail(quote(token) + " is not a finite number");
  if (isTooLarge(literal)) fail(quote(token) + " is too large for a double");
  return 0;
}

double TextScanner::numberOrNan(std::string_view token) const {
  if (isUndefined(withoutPlus(token))) return std::numeric_limits<double>::quiet_NaN();
  return number(token);
}

double TextScanner::coordinate(std::string_view token) const {
  const std::string_view text = withoutPlus(token);
  const char* const textEnd = text.data() + text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), textEnd, value);
  if (error == std::errc{} && stop == textEnd && std::abs(value) <= kMaxCoordinate) [[likely]]
    return value;
  value = numberOrNan(token);
  if (std::abs(value) > kMaxCoordinate)
    fail("coordinate " + quote(token) + " is larger than 1e15; scale the model down");
  return value;
}

std::int64_t TextScanner::unusualInteger(std::string_view token) const {
  const std::string_view text = withoutPlus(token);
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) fail(quote(token) + " is too large for an index");
  if (error != std::errc{} || stop != text.data() + text.size())
    fail("expected a whole number, found " + quote(token));
  return value;
}

void TextScanner::failAt(std::size_t line, const std::string& what) const {
  throw InputError(fileName_ + ":" + std::to_string(line) + ": " + what);
}

}  // namespace vox
