#pragma once

#include <filesystem>
#include <string>

#include "app/report/plot/plots.h"
#include "app/tradeoff/tradeoff.h"

namespace annulus::app {

/// tradeoff.csv: one row per ring or pair, setting and figure.
[[nodiscard]] std::string trade_csv(const TradeOff& trade);
/// tradeoff.html, self-contained: pictures of error against wall time, the cheapest settings, every measurement.
[[nodiscard]] std::string trade_html(const TradeOff& trade);
/// Error against wall time with the front of settings that nothing beats, as a picture of its own.
[[nodiscard]] Plot trade_plot(const VariantTrade& variant, TradePart part);
/// For the standard output: the cheapest setting for 10 %, 1 % and 0.1 %, and the front.
[[nodiscard]] std::string trade_text(const TradeOff& trade);

/// Writes tradeoff.csv, tradeoff.html and the pictures as SVG into `folder`.
void write_tradeoff(const TradeOff& trade, const std::filesystem::path& folder);

}  // namespace annulus::app
