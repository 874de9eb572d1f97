#pragma once

#include <memory>

#include "app/model/trade_subject.h"

namespace annulus::app {

/// What the cost study measures of one ring of a planetary stage. It refers to the scene.
[[nodiscard]] std::unique_ptr<TradeSubject> planetary_trade_subject(const Scene& scene, std::size_t ring);

}  // namespace annulus::app
