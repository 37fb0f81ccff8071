#include "reports/document/definitions.hpp"

namespace elastocheck::reports {

std::string definition(const compare::Channel& channel) {
    const std::string& name = channel.name;
    if (channel.joint >= 0)
        return channel.unit == compare::Unit::newton
                   ? "force of the joint on its first body, ground axes"
                   : "moment of the joint on its first body about the joint's point, ground axes";
    if (name.ends_with("toe"))
        return "atan2(e_x, side·e_y), e the spin axis pointing outboard, side +1 left, -1 right; positive "
               "toe-in; of "
               "this wheel alone";
    if (name.ends_with("camber"))
        return "-asin(e_z), e the spin axis pointing outboard; positive when the top leans out; of this "
               "wheel alone";
    if (name.find("wheel_centre_") != name.npos)
        return "position of the wheel centre, ground axes: x forward, y left, z up";
    return "position of the probe, ground axes: x forward, y left, z up";
}

}  // namespace elastocheck::reports
