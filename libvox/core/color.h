#pragma once

namespace vox {

/// The share of light, 0 to 1, that a screen makes of a value, 0 to 1, as files and pictures store
/// it. Source: IEC 61966-2-1 (sRGB).
double linearFromScreen(double value);

}  // namespace vox
