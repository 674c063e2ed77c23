#pragma once

namespace vox {

/// Linear light, 0 to 1, of a colour value as files store it (sRGB), 0 to 1.
/// Source: IEC 61966-2-1.
double linearFromScreen(double value);
/// The inverse.
double screenFromLinear(double light);

/// Linear grey value of things without a colour.
inline constexpr float kPlainColor = 0.8F;

}  // namespace vox
