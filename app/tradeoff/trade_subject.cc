#include "app/tradeoff/trade_subject.h"

namespace annulus::app {

std::vector<std::unique_ptr<TradeSubject>> trade_subjects(const Scene& scene) {
  std::vector<std::unique_ptr<TradeSubject>> list;
  switch (scene.stage.kind) {
    case StageKind::planetary:
      for (std::size_t i = 0; i < scene.rings.size(); ++i) list.push_back(planetary_trade_subject(scene, i));
      break;
    case StageKind::helical_pair:
      list.push_back(pair_trade_subject(scene));
      break;
    case StageKind::two_k_v:
      list.push_back(two_k_v_trade_subject(scene));
      break;
  }
  return list;
}

}  // namespace annulus::app
