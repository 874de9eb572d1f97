#pragma once

#include <array>
#include <cstddef>

namespace annulus::geometry {

/// The members of a planetary stage that carry power.
enum class StageMember { sun, carrier, ring };
inline constexpr StageMember stage_members[] = {StageMember::sun, StageMember::carrier, StageMember::ring};
[[nodiscard]] constexpr const char* to_string(StageMember member) {
  constexpr const char* names[] = {"sun", "carrier", "ring"};
  return names[static_cast<int>(member)];
}

/// One value for each member, by StageMember.
class MemberValues {
 public:
  MemberValues() = default;
  MemberValues(double sun, double carrier, double ring) : values_{sun, carrier, ring} {}
  [[nodiscard]] double operator[](StageMember member) const { return values_[static_cast<std::size_t>(member)]; }
  [[nodiscard]] double& operator[](StageMember member) { return values_[static_cast<std::size_t>(member)]; }

 private:
  std::array<double, 3> values_{};
};

/// Speeds and external torques of sun, carrier and ring, counter-clockwise. With the weights w = (z_s, -(z_s + z_r),
/// z_r) the speeds of a stage without losses obey sum of w omega = 0 (Willis) and the torques are proportional to w.
/// The sum of the torques and the sum of the powers are then zero.
struct PowerFlow {
  MemberValues speed;   ///< rad/s
  MemberValues torque;  ///< N m, acting on the member from outside
  /// W, positive where the member drives.
  [[nodiscard]] double power(StageMember member) const { return torque[member] * speed[member]; }
};

struct KnownSpeed {
  StageMember member = StageMember::ring;
  double speed = 0;  ///< rad/s
};

/// The weights above.
[[nodiscard]] MemberValues tooth_weights(int sun_teeth, int ring_teeth);
/// All speeds from those of two different members. Throws GeometryError for one member twice.
[[nodiscard]] MemberValues member_speeds(int sun_teeth, int ring_teeth, KnownSpeed first, KnownSpeed second);
/// The torques with that of one member, N m.
[[nodiscard]] MemberValues member_torques(int sun_teeth, int ring_teeth, StageMember member, double torque);

}  // namespace annulus::geometry
