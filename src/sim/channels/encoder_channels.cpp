// SPDX-License-Identifier: Apache-2.0
#include "sim/channels/part_channels.h"
#include "sim/world.h"
#include "sim/world_parts.h"

namespace navvy::sim {

// Fault inputs belong to no machine: setting one does not end the machine's program.
void add_encoder_channels(const MachineChannels& out) {
  vehicle::Encoders& encoders =
      parts(out.world).encoders[static_cast<std::size_t>(out.machine.index())];
  for (std::size_t i = 0; i < encoders.size(); ++i) {
    // The encoders of a machine never change in number, so the pointers stay valid.
    vehicle::JointEncoder* encoder = &encoders[i];
    const std::string base = out.prefix + encoder->about().joint + "/";
    const std::string bits = std::to_string(encoder->about().bits);
    out.outputs.add({base + "counts", "1", "register of the encoder, wraps at 2^" + bits},
                    [encoder] { return static_cast<double>(encoder->counts()); });
    out.inputs.add(
        {base + "encoder_slip", "1", "slip added to the counts, -0.9 to 0.9", -1, -0.9, 0.9},
        [encoder](double slip) { encoder->set_slip(slip); });
    out.inputs.add({base + "encoder_missed", "1", "share of lost counts, 0 to 1", -1, 0, 1},
                   [encoder](double share) { encoder->set_missed(share); });
  }
}

}  // namespace navvy::sim
