#include "apps/bench/plot.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vox::bench {
namespace {

constexpr double kWidth = 900;
constexpr double kHeight = 440;
constexpr double kLeft = 60;
constexpr double kRight = 330;  // the legend
constexpr double kTop = 40;
constexpr double kBottom = 50;
/// Colours that most colour-blind people can distinguish (Okabe and Ito).
constexpr std::array<const char*, 8> kColors = {"#000000", "#0072b2", "#56b4e9", "#009e73",
                                                "#d55e00", "#e69f00", "#cc79a7", "#999999"};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else
      result += c;
  }
  return result;
}

/// Maps values to positions along an axis.
struct Axis {
  double low = 1e300;
  double high = 0;
  double from = 0;
  double to = 1;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double at(double value) const {
    return from + (to - from) * std::log(value / low) / std::log(high / low);
  }
};

void text(std::ostringstream& out, double x, double y, const char* anchor,
          const std::string& what) {
  out << "<text x='" << x << "' y='" << y << "' text-anchor='" << anchor << "'>" << escaped(what)
      << "</text>\n";
}

void line(std::ostringstream& out, double x1, double y1, double x2, double y2) {
  out << "<path d='M" << x1 << ' ' << y1 << 'L' << x2 << ' ' << y2 << "' stroke='#ccc'/>\n";
}

void drawGrid(std::ostringstream& out, const Plot& plot, const Axis& x, const Axis& y) {
  const auto label = [](double value) {
    std::ostringstream short_;
    short_ << value;
    return short_.str();
  };
  for (double tick = std::pow(10, std::round(std::log10(y.low))); tick <= y.high * 1.001;
       tick *= 10) {
    line(out, x.from, y.at(tick), x.to, y.at(tick));
    text(out, x.from - 6, y.at(tick) + 4, "end", label(tick));
  }
  std::vector<double> ticks;
  for (const Curve& curve : plot.curves)
    for (const auto& point : curve.points) ticks.push_back(point[0]);
  std::sort(ticks.begin(), ticks.end());
  ticks.erase(std::unique(ticks.begin(), ticks.end()), ticks.end());
  for (const double tick : ticks) {
    line(out, x.at(tick), y.from, x.at(tick), y.to);
    text(out, x.at(tick), y.from + 18, "middle", label(tick));
  }
}

void drawCurve(std::ostringstream& out, const Curve& curve, std::size_t number, const Axis& x,
               const Axis& y) {
  const char* color = kColors[number % kColors.size()];
  const char* dashes = number < kColors.size() ? "" : " stroke-dasharray='6 4'";
  out << "<polyline fill='none' stroke-width='2' stroke='" << color << "'" << dashes << " points='";
  for (const auto& [atX, atY] : curve.points) out << x.at(atX) << ',' << y.at(atY) << ' ';
  out << "'/>\n";
  for (const auto& [atX, atY] : curve.points)
    out << "<circle r='3' fill='" << color << "' cx='" << x.at(atX) << "' cy='" << y.at(atY)
        << "'/>\n";
  const double row = kTop + 20 * static_cast<double>(number);
  out << "<path d='M" << x.to + 14 << ' ' << row << "h24' stroke-width='2' stroke='" << color << "'"
      << dashes << "/>\n";
  text(out, x.to + 44, row + 4, "start", curve.name);
}

}  // namespace

std::string svgOf(const Plot& plot) {
  Axis x{.from = kLeft, .to = kWidth - kRight};
  Axis y{.from = kHeight - kBottom, .to = kTop};
  for (const Curve& curve : plot.curves)
    for (const auto& point : curve.points) {
      x.add(point[0]);
      y.add(point[1]);
    }
  x.high = std::max(x.high, x.low * 1.01);
  y.low = std::pow(10, std::floor(std::log10(y.low)));
  y.high = std::max(std::pow(10, std::ceil(std::log10(y.high))), y.low * 10);
  std::ostringstream out;
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << kWidth << ' ' << kHeight
      << "' font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' "
         "fill='white'/>\n";
  text(out, kLeft, 22, "start", plot.title);
  if (!plot.curves.empty()) drawGrid(out, plot, x, y);
  text(out, (x.from + x.to) / 2, kHeight - 10, "middle", plot.x);
  for (std::size_t i = 0; i < plot.curves.size(); ++i) drawCurve(out, plot.curves[i], i, x, y);
  return out.str() + "</svg>\n";
}

}  // namespace vox::bench
