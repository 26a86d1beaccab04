// SPDX-License-Identifier: Apache-2.0
// Named inputs and outputs of a world: how any controller, in any language, reaches it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace navvy::sim {

/// One named number, e.g. "ew180/boom_joint/position" in rad. Its name is
/// "<machine>/<part>/<quantity>", or "<sampler>/<quantity>"; it never changes while the world
/// lives.
struct Channel {
  std::string name;
  std::string unit;
  std::string meaning;
  int machine = -1;  ///< the machine it drives or tells of, as in scene::Scene::machines; -1: none
};

/// A list of channels with a function each; names are unique, what was added keeps its index.
template <class Function>
class ChannelList {
 public:
  /// The name must be new: an earlier channel of the same name could no longer be found by it.
  void add(Channel channel, Function function) {
    index_[channel.name] = static_cast<int>(channels_.size());
    channels_.push_back(std::move(channel));
    functions_.push_back(std::move(function));
  }
  /// In the order of their indices, which telemetry and bindings keep.
  const std::vector<Channel>& channels() const { return channels_; }
  /// -1 when there is none of this name.
  int find(const std::string& name) const {
    const auto it = index_.find(name);
    return it == index_.end() ? -1 : it->second;
  }
  /// @throws std::out_of_range.
  const Function& function(int i) const { return functions_.at(static_cast<std::size_t>(i)); }

 private:
  std::vector<Channel> channels_;
  std::vector<Function> functions_;
  std::map<std::string, int> index_;
};

// What a world has of them. A function reads or drives through handles and takes no time to find
// its part.
using Inputs = ChannelList<std::function<void(double)>>;
using Outputs = ChannelList<std::function<double()>>;

}  // namespace navvy::sim
