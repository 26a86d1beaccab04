// SPDX-License-Identifier: Apache-2.0
// Named inputs and outputs of a world: how any controller, in any language, reaches it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace navvy::sim {

/// One named number, e.g. "ew180/boom_joint/position" in rad.
struct Channel {
  std::string name;
  std::string unit;
  std::string meaning;
};

/// A list of channels with a function each; names are unique, the order is fixed at construction.
template <class Function>
class ChannelList {
 public:
  void add(Channel channel, Function function) {
    index_[channel.name] = static_cast<int>(channels_.size());
    channels_.push_back(std::move(channel));
    functions_.push_back(std::move(function));
  }
  const std::vector<Channel>& channels() const { return channels_; }
  /// -1 when there is none of this name.
  int find(const std::string& name) const {
    const auto it = index_.find(name);
    return it == index_.end() ? -1 : it->second;
  }
  const Function& function(int i) const { return functions_.at(static_cast<std::size_t>(i)); }

 private:
  std::vector<Channel> channels_;
  std::vector<Function> functions_;
  std::map<std::string, int> index_;
};

using Inputs = ChannelList<std::function<void(double)>>;
using Outputs = ChannelList<std::function<double()>>;

}  // namespace navvy::sim
