// SPDX-License-Identifier: Apache-2.0
// Named inputs and outputs (channels) of a world, the interface for controllers in any language.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace navvy::sim {

/// Description of one input or output, a named number such as "ew180/boom_joint/position" in rad.
/// It never changes.
struct Channel {
  /// Channel name: "<machine>/<part>/<quantity>" or "<sampler>/<quantity>".
  std::string name;
  /// Unit of the number as text; "1" for a dimensionless number.
  std::string unit;
  /// One-line description of the number.
  std::string meaning;
  /// Index in scene::Scene::machines of the machine that the channel commands; -1 if it commands
  /// none.
  int machine = -1;
  /// Bounds of an input, in its unit; infinite for outputs and for inputs without bounds.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  /// True: a value beyond the bounds acts like the nearer bound. False: it is refused.
  bool clamped = false;
};

/// List of channels in which each channel has a function that sets or reads its value. Names are
/// unique, and the index of a channel never changes.
template <class Function>
class ChannelList {
 public:
  /// Appends a channel and the function that sets or reads its value. The name must not be in the
  /// list yet; this is not checked.
  void add(Channel channel, Function function) {
    index_[channel.name] = static_cast<int>(channels_.size());
    channels_.push_back(std::move(channel));
    functions_.push_back(std::move(function));
  }
  /// Returns all channels in the order of their indices.
  const std::vector<Channel>& channels() const { return channels_; }
  /// Returns the number of channels.
  std::size_t size() const { return channels_.size(); }
  /// Returns the channel with index `i`, which is not checked.
  const Channel& operator[](std::size_t i) const { return channels_[i]; }
  /// Returns an iterator to the first channel; iteration follows the order of the indices.
  auto begin() const { return channels_.begin(); }
  /// Returns the iterator past the last channel.
  auto end() const { return channels_.end(); }
  /// Returns the index of the channel with this name, or -1 if there is none.
  int find(const std::string& name) const {
    const auto it = index_.find(name);
    return it == index_.end() ? -1 : it->second;
  }

 protected:
  /// Returns the function of the channel with index `i`.
  /// @throws std::out_of_range for an index that does not exist.
  const Function& function(int i) const { return functions_.at(static_cast<std::size_t>(i)); }

 private:
  std::vector<Channel> channels_;
  /// Function of each channel, in the order of `channels_`.
  std::vector<Function> functions_;
  /// Index of each channel, keyed by its name.
  std::map<std::string, int> index_;
};

/// Inputs of a world, which clients set by name or index. An input may have the same name as an
/// output: the input is then the target, and the output is the measured value.
class Inputs : public ChannelList<std::function<void(double)>> {
 public:
  /// Returns the index of the input with this name.
  /// @throws InputError if there is none; the message names the most similar input.
  int index(const std::string& name) const;
  /// Checks that the input with the index `input` takes `value`; changes nothing.
  /// @throws InputError as `set` does.
  void require(int input, double value) const;
  /// Sets the input with the index `input` to `value`, in the unit of the input. Costs one function
  /// call.
  /// @throws InputError for a value that is not finite or beyond the bounds of an input that does
  /// not clamp it, and for an index that does not exist.
  void set(int input, double value);
  /// Sets the input called `name` to `value`, in the unit of the input. Searches for the name in
  /// each call.
  /// @throws InputError for an unknown name or a value that is not finite.
  void set(const std::string& name, double value) { set(index(name), value); }
};

/// Outputs of a world, which clients read by name or index. Samplers append outputs to the list.
class Outputs : public ChannelList<std::function<double()>> {
 public:
  /// Returns the index of the output with this name.
  /// @throws InputError if there is none; the message names the most similar output.
  int index(const std::string& name) const;
  /// Returns the current value of the output with the index `output`, in the unit of the output. A
  /// payload costs a pass over all particles; other outputs cost one function call.
  /// @throws InputError for an index that does not exist.
  double get(int output) const;
  /// Returns the current value of the output called `name`, in the unit of the output. Searches for
  /// the name in each call.
  /// @throws InputError for an unknown name.
  double get(const std::string& name) const { return get(index(name)); }
};

}  // namespace navvy::sim
