#pragma once

#include <memory>

#include "app/model/trade_subject.h"

namespace annulus::app {

/// What the cost study measures of a helical pair. It refers to the scene.
[[nodiscard]] std::unique_ptr<TradeSubject> pair_trade_subject(const Scene& scene);

}  // namespace annulus::app
