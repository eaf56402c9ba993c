#pragma once
/// Filter of measured and computed crash signals.

#include <span>
#include <vector>

namespace brio {

/// Channel frequency class filter of SAE J211-1: a two-pole Butterworth low pass with the corner 2.0775 CFC,
/// forwards and backwards, so that no phase is shifted; 6 dB at the corner, 3 dB at 1.65 CFC about. Before
/// the first and after the last sample the signal goes on as its reflection in the end point.
/// \param interval between samples, s \param channel_class Hz
/// \throws std::invalid_argument where there are fewer than two samples per period of the corner
std::vector<double> filter_cfc(std::span<const double> samples, double interval, double channel_class);

/// Values at equally spaced times, linear between those given. \param times ascending, two or more
std::vector<double> resampled(std::span<const double> times, std::span<const double> values,
                              std::size_t count);

}  // namespace brio
