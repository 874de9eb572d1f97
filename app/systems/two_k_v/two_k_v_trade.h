#pragma once

#include <memory>

#include "app/model/trade_subject.h"

namespace annulus::app {

/// What the cost study measures of a 2K-V stage. It refers to the scene.
[[nodiscard]] std::unique_ptr<TradeSubject> two_k_v_trade_subject(const Scene& scene);

}  // namespace annulus::app
