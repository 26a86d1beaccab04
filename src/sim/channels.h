// SPDX-License-Identifier: Apache-2.0
// Named inputs and outputs of a world: the interface for controllers in any language.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace navvy::sim {

/// One named number, e.g. "ew180/boom_joint/position" in rad.
///
/// The name is "<machine>/<part>/<quantity>" or "<sampler>/<quantity>". It never changes.
struct Channel {
  std::string name;
  std::string unit;
  std::string meaning;
  /// Index of the machine that the channel drives or describes, as in scene::Scene::machines; -1
  /// for none.
  int machine = -1;
};

/// A list of channels with one function each. Names are unique and indices never change.
template <class Function>
class ChannelList {
 public:
  /// Appends a channel. Its name must be new.
  void add(Channel channel, Function function) {
    index_[channel.name] = static_cast<int>(channels_.size());
    channels_.push_back(std::move(channel));
    functions_.push_back(std::move(function));
  }
  /// Returns all channels in the order of their indices.
  const std::vector<Channel>& channels() const { return channels_; }
  /// Returns the number of channels.
  std::size_t size() const { return channels_.size(); }
  /// Returns a channel. The index is not checked.
  const Channel& operator[](std::size_t i) const { return channels_[i]; }
  /// Iterates over the channels in the order of their indices.
  auto begin() const { return channels_.begin(); }
  auto end() const { return channels_.end(); }
  /// Returns the index of a channel, -1 if there is none of this name.
  int find(const std::string& name) const {
    const auto it = index_.find(name);
    return it == index_.end() ? -1 : it->second;
  }

 protected:
  /// @throws std::out_of_range.
  const Function& function(int i) const { return functions_.at(static_cast<std::size_t>(i)); }

 private:
  std::vector<Channel> channels_;
  std::vector<Function> functions_;
  std::map<std::string, int> index_;
};

/// The inputs of a world. An input and an output may share a name: one is the target, the other
/// the measured value.
class Inputs : public ChannelList<std::function<void(double)>> {
 public:
  /// Returns the index of an input. @throws InputError that names the nearest input.
  int index(const std::string& name) const;
  /// Sets an input to `value`, in the input's unit, at the cost of a function call.
  /// @throws InputError for a value that is not finite or an index that does not exist.
  void set(int input, double value);
  /// Looks the input up by its name first.
  void set(const std::string& name, double value) { set(index(name), value); }
};

/// The outputs of a world. Samplers append theirs.
class Outputs : public ChannelList<std::function<double()>> {
 public:
  /// Returns the index of an output. @throws InputError that names the nearest output.
  int index(const std::string& name) const;
  /// Returns the present value in the output's unit. A payload costs a pass over the particles, any
  /// other output a function call. @throws InputError for an index that does not exist.
  double get(int output) const;
  /// Looks the output up by its name first.
  double get(const std::string& name) const { return get(index(name)); }
};

}  // namespace navvy::sim
