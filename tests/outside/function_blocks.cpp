// Runs programs of function blocks of pyplcopen on its own axis, which follows its set-points.
//
// Programs and answers are those of the example `block_lines` of the crate `plcopen`. A cycle is what happens to the drive, the cycle
// of the axis, then the calls; pyplcopen counts time in cycles.
#include "axis/state.h"
#include "fb/homing.h"
#include "fb/io.h"
#include "fb/motion.h"
#include "fb/parameter.h"
#include "fb/probe.h"
#include "fb/profile.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace axis = plcopen::core::axis;
namespace fb = plcopen::core::fb;
namespace rt = plcopen::core::rt;

namespace {

[[noreturn]] void fail(const std::string &why) {
    std::cerr << why << '\n';
    std::exit(1);
}

double number(const std::string &word) { return std::strtod(word.c_str(), nullptr); }

bool flag(const std::string &word) {
    if (word != "true" && word != "false") {
        fail(word + " is neither true nor false");
    }
    return word == "true";
}

/// The value of this name.
template <class Value>
Value choice(const std::map<std::string, Value> &values, const std::string &word) {
    const auto found = values.find(word);
    if (found == values.end()) {
        fail(word + " is not among the alternatives of pyplcopen");
    }
    return found->second;
}

const std::map<std::string, axis::BufferMode> buffer_modes{
    {"aborting", axis::BufferMode::aborting},
    {"buffered", axis::BufferMode::buffered},
    {"blending-low", axis::BufferMode::blending_low},
    {"blending-high", axis::BufferMode::blending_high},
};
const std::map<std::string, axis::Direction> directions{
    {"current", axis::Direction::current},
    {"positive", axis::Direction::positive},
    {"negative", axis::Direction::negative},
    {"shortest", axis::Direction::shortest_way},
};
const std::map<std::string, axis::AxisParameter> parameters{
    {"commanded-position", axis::AxisParameter::commanded_position},
    {"sw-limit-pos", axis::AxisParameter::sw_limit_pos},
    {"sw-limit-neg", axis::AxisParameter::sw_limit_neg},
    {"enable-limit-pos", axis::AxisParameter::enable_limit_pos},
    {"enable-limit-neg", axis::AxisParameter::enable_limit_neg},
    {"enable-pos-lag-monitoring", axis::AxisParameter::enable_pos_lag_monitoring},
    {"max-position-lag", axis::AxisParameter::max_position_lag},
    {"max-velocity-system", axis::AxisParameter::max_velocity_system},
    {"max-velocity-appl", axis::AxisParameter::max_velocity_appl},
    {"actual-velocity", axis::AxisParameter::actual_velocity},
    {"commanded-velocity", axis::AxisParameter::commanded_velocity},
    {"max-acceleration-system", axis::AxisParameter::max_acceleration_system},
    {"max-acceleration-appl", axis::AxisParameter::max_acceleration_appl},
    {"max-deceleration-system", axis::AxisParameter::max_deceleration_system},
    {"max-deceleration-appl", axis::AxisParameter::max_deceleration_appl},
    {"max-jerk-system", axis::AxisParameter::max_jerk_system},
    {"max-jerk-appl", axis::AxisParameter::max_jerk_appl},
};
/// The digital inputs that are switches, and the one that stands for the index pulse.
constexpr std::size_t negative = 0, positive = 1, home = 2, index_pulse = 3;
const std::map<std::string, std::size_t> triggers{{"home-switch-met", home}, {"index-pulse", index_pulse}};

/// An axis that is told from outside what happens to its drive.
struct Bench {
    axis::AxisModel axis;
    double encoder = 0.0;

    /// The drive gives the effort that it is told to.
    void give_effort() {
        const axis::AxisSnapshot now = axis.snapshot();
        axis.set_actual_feedback(now.actual_position, now.actual_velocity, now.actual_acceleration, now.command_torque);
    }

    void set(const std::string &key, const std::string &value) {
        axis::AxisModel::AxisInfoInputs info = axis.axis_info_inputs();
        if (key.rfind("input.", 0) == 0) {
            const auto bit = static_cast<std::size_t>(number(key.substr(6)));
            const bool level = flag(value);
            axis.set_digital_input(bit, level);
            (bit == negative ? info.limit_switch_neg : bit == positive ? info.limit_switch_pos : info.home_abs_switch) =
                bit == index_pulse ? info.home_abs_switch : level;
        } else if (key == "fault") {
            if (flag(value)) {
                axis.trigger_error(rt::ErrorCode::precondition_failed);
            }
            info.ready_for_power_on = !flag(value);
        } else if (key == "warning") {
            info.warning = flag(value);
        } else if (key == "power") {
            axis.set_power_feedback(flag(value));
        } else {
            fail("the drive has no " + key);
        }
        axis.set_axis_info_inputs(info);
    }
};

/// An instance of a block, its inputs and outputs by their names.
struct Block {
    std::shared_ptr<void> held;
    std::string name;
    std::map<std::string, std::function<void(const std::string &)>> inputs;
    std::vector<std::pair<const char *, std::function<double()>>> outputs;
    std::vector<double> told;
    std::function<void()> call;

    void takes(const char *key, double &place) {
        inputs[key] = [&place](const std::string &word) { place = number(word); };
    }
    void takes(const char *key, bool &place) {
        inputs[key] = [&place](const std::string &word) { place = flag(word); };
    }
    void takes(const char *key, std::size_t &place) {
        inputs[key] = [&place](const std::string &word) { place = static_cast<std::size_t>(number(word)); };
    }
    template <class Value>
    void takes(const char *key, Value &place, const std::map<std::string, Value> &values) {
        inputs[key] = [&place, &values](const std::string &word) { place = choice(values, word); };
    }
    void gives(const char *name, const bool &place) {
        outputs.emplace_back(name, [&place] { return place ? 1.0 : 0.0; });
    }
    void gives(const char *name, const double &place) {
        outputs.emplace_back(name, [&place] { return place; });
    }
    void gives(const char *name, const rt::ErrorCode &place) {
        outputs.emplace_back(name, [&place] { return static_cast<double>(place); });
    }
    void gives_done(const fb::MotionOutputs &places) {
        gives("Done", places.done);
        gives("Busy", places.busy);
        gives("Error", places.error);
        gives("ErrorID", places.error_id);
    }
    void gives_command(const fb::MotionOutputs &places) {
        gives("Busy", places.busy);
        gives("Active", places.active);
        gives("CommandAborted", places.command_aborted);
        gives("Error", places.error);
        gives("ErrorID", places.error_id);
    }
};

template <class Fb>
Fb &hold(Block &block, Bench &bench) {
    auto held = std::make_shared<Fb>();
    Fb &made = *held;
    block.held = std::move(held);
    made.axis_ref = &bench.axis;
    block.call = [&made] { made.call(); };
    return made;
}

template <class Fb>
Fb &executed(Block &block, Bench &bench) {
    Fb &made = hold<Fb>(block, bench);
    block.takes("execute", made.execute);
    return made;
}

template <class Fb>
Fb &enabled(Block &block, Bench &bench) {
    Fb &made = hold<Fb>(block, bench);
    block.takes("enable", made.enable);
    return made;
}

/// A block that reads.
template <class Fb>
Fb &reads(Block &block, Bench &bench) {
    Fb &made = enabled<Fb>(block, bench);
    block.gives("Valid", made.valid);
    block.gives("Busy", made.busy);
    block.gives("Error", made.error);
    block.gives("ErrorID", made.error_id);
    return made;
}

/// A block that writes.
template <class Fb>
Fb &writes(Block &block, Bench &bench) {
    Fb &made = executed<Fb>(block, bench);
    block.gives("Done", made.done);
    block.gives("Busy", made.busy);
    block.gives("Error", made.error);
    block.gives("ErrorID", made.error_id);
    return made;
}

template <class Fb>
void takes_limits(Block &block, Fb &made) {
    block.takes("velocity", made.velocity);
    block.takes("acceleration", made.acceleration);
    block.takes("deceleration", made.deceleration);
    block.takes("jerk", made.jerk);
}

/// A block that moves to an end.
template <class Fb>
Fb &moves(Block &block, Bench &bench) {
    Fb &made = executed<Fb>(block, bench);
    takes_limits(block, made);
    block.takes("buffer_mode", made.buffer_mode, buffer_modes);
    block.takes("continuous_update", made.continuous_update);
    block.gives("Done", made.outputs.done);
    block.gives_command(made.outputs);
    return made;
}

template <class Fb>
Fb &moves_on(Block &block, Bench &bench) {
    Fb &made = executed<Fb>(block, bench);
    takes_limits(block, made);
    block.takes("end_velocity", made.end_velocity);
    block.takes("buffer_mode", made.buffer_mode, buffer_modes);
    block.takes("continuous_update", made.continuous_update);
    block.takes("direction", made.direction, directions);
    block.gives("InEndVelocity", made.in_end_velocity);
    block.gives_command(made.outputs);
    return made;
}

/// A block that follows a table: TIME:VALUE,TIME:VALUE, in whole cycles from row to row.
template <class Fb>
Fb &follows(Block &block, Bench &bench, const char *completed) {
    Fb &made = executed<Fb>(block, bench);
    auto rows = std::make_shared<std::vector<axis::ProfileSegment>>();
    block.inputs["table"] = [&made, rows](const std::string &words) {
        rows->clear();
        std::istringstream table(words);
        for (std::string word; std::getline(table, word, ',');) {
            axis::ProfileSegment row{};
            row.duration_cycles = static_cast<std::int64_t>(number(word));
            row.target = number(word.substr(word.find(':') + 1));
            rows->push_back(row);
        }
        made.segments = rows->data();
        made.segment_count = rows->size();
    };
    block.takes("time_scale", made.time_scale);
    block.takes("buffer_mode", made.buffer_mode, buffer_modes);
    block.gives(completed, made.outputs.done);
    block.gives_command(made.outputs);
    return made;
}

using Make = void (*)(Block &, Bench &);

const std::map<std::string, Make> makes{
    {"MC_Power",
     [](Block &block, Bench &bench) {
         fb::FbPower &made = enabled<fb::FbPower>(block, bench);
         block.takes("enable_positive", made.enable_positive);
         block.takes("enable_negative", made.enable_negative);
         block.gives("Status", made.status);
         block.gives("Valid", made.valid);
         block.gives("Error", made.error);
         block.gives("ErrorID", made.error_id);
     }},
    {"MC_Reset",
     [](Block &block, Bench &bench) { block.gives_done(executed<fb::FbReset>(block, bench).outputs); }},
    {"MC_SetOverride",
     [](Block &block, Bench &bench) {
         fb::FbSetOverride &made = enabled<fb::FbSetOverride>(block, bench);
         block.takes("velocity_factor", made.vel_factor);
         block.takes("acceleration_factor", made.acc_factor);
         block.takes("jerk_factor", made.jerk_factor);
         block.gives("Enabled", made.enabled);
         block.gives("Busy", made.busy);
         block.gives("Error", made.error);
         block.gives("ErrorID", made.error_id);
     }},
    {"MC_MoveAbsolute",
     [](Block &block, Bench &bench) {
         fb::FbMoveAbsolute &made = moves<fb::FbMoveAbsolute>(block, bench);
         block.takes("position", made.position);
         block.takes("direction", made.direction, directions);
     }},
    {"MC_MoveRelative",
     [](Block &block, Bench &bench) {
         block.takes("distance", moves<fb::FbMoveRelative>(block, bench).distance);
     }},
    {"MC_MoveAdditive",
     [](Block &block, Bench &bench) {
         block.takes("distance", moves<fb::FbMoveAdditive>(block, bench).distance);
     }},
    {"MC_MoveVelocity",
     [](Block &block, Bench &bench) {
         fb::FbMoveVelocity &made = executed<fb::FbMoveVelocity>(block, bench);
         takes_limits(block, made);
         block.takes("buffer_mode", made.buffer_mode, buffer_modes);
         block.takes("continuous_update", made.continuous_update);
         block.takes("direction", made.direction_mode, directions);
         block.gives("InVelocity", made.in_velocity);
         block.gives_command(made.outputs);
     }},
    {"MC_MoveContinuousAbsolute",
     [](Block &block, Bench &bench) {
         block.takes("position", moves_on<fb::FbMoveContinuousAbsolute>(block, bench).position);
     }},
    {"MC_MoveContinuousRelative",
     [](Block &block, Bench &bench) {
         block.takes("distance", moves_on<fb::FbMoveContinuousRelative>(block, bench).distance);
     }},
    {"MC_MoveSuperimposed",
     [](Block &block, Bench &bench) {
         fb::FbMoveSuperimposed &made = executed<fb::FbMoveSuperimposed>(block, bench);
         block.takes("distance", made.distance);
         block.takes("velocity_difference", made.velocity);
         block.takes("acceleration", made.acceleration);
         block.takes("deceleration", made.deceleration);
         block.takes("jerk", made.jerk);
         block.takes("continuous_update", made.continuous_update);
         block.gives_done(made.outputs);
         block.gives("CommandAborted", made.outputs.command_aborted);
         block.gives("CoveredDistance", made.covered_distance);
     }},
    {"MC_HaltSuperimposed",
     [](Block &block, Bench &bench) {
         fb::FbHaltSuperimposed &made = executed<fb::FbHaltSuperimposed>(block, bench);
         block.takes("deceleration", made.deceleration);
         block.takes("jerk", made.jerk);
         block.gives_done(made.outputs);
         block.gives("CommandAborted", made.outputs.command_aborted);
     }},
    {"MC_Halt",
     [](Block &block, Bench &bench) {
         fb::FbHalt &made = executed<fb::FbHalt>(block, bench);
         block.takes("deceleration", made.deceleration);
         block.takes("jerk", made.jerk);
         block.takes("buffer_mode", made.buffer_mode, buffer_modes);
         block.gives("Done", made.outputs.done);
         block.gives_command(made.outputs);
     }},
    {"MC_Stop",
     [](Block &block, Bench &bench) {
         fb::FbStop &made = executed<fb::FbStop>(block, bench);
         block.takes("deceleration", made.deceleration);
         block.takes("jerk", made.jerk);
         block.gives_done(made.outputs);
         block.gives("CommandAborted", made.outputs.command_aborted);
     }},
    {"MC_PositionProfile",
     [](Block &block, Bench &bench) { follows<fb::FbPositionProfile>(block, bench, "Done"); }},
    {"MC_VelocityProfile",
     [](Block &block, Bench &bench) { follows<fb::FbVelocityProfile>(block, bench, "ProfileCompleted"); }},
    {"MC_AccelerationProfile",
     [](Block &block, Bench &bench) { follows<fb::FbAccelerationProfile>(block, bench, "ProfileCompleted"); }},
    {"MC_TorqueControl",
     [](Block &block, Bench &bench) {
         fb::FbTorqueControl &made = executed<fb::FbTorqueControl>(block, bench);
         made.set_cycle_time(1'000'000'000);
         block.takes("torque", made.torque);
         block.takes("torque_ramp", made.torque_ramp);
         block.takes("velocity", made.velocity);
         block.takes("direction", made.direction, directions);
         block.takes("buffer_mode", made.buffer_mode, buffer_modes);
         block.takes("continuous_update", made.continuous_update);
         block.gives("InTorque", made.in_torque);
         block.gives_command(made.outputs);
     }},
    {"MC_SetPosition",
     [](Block &block, Bench &bench) {
         fb::FbSetPosition &made = executed<fb::FbSetPosition>(block, bench);
         block.takes("position", made.position);
         block.takes("relative", made.relative);
         block.gives_done(made.outputs);
     }},
    {"MC_HomeDirect",
     [](Block &block, Bench &bench) {
         fb::FbHomeDirect &made = executed<fb::FbHomeDirect>(block, bench);
         block.takes("position", made.set_position);
         block.takes("buffer_mode", made.buffer_mode, buffer_modes);
         block.gives("Done", made.outputs.done);
         block.gives_command(made.outputs);
     }},
    {"MC_HomeAbsolute",
     [](Block &block, Bench &bench) {
         fb::FbHomeAbsolute &made = executed<fb::FbHomeAbsolute>(block, bench);
         made.bind_source(&bench.encoder);
         block.takes("buffer_mode", made.buffer_mode, buffer_modes);
         block.gives("Done", made.outputs.done);
         block.gives_command(made.outputs);
     }},
    {"MC_TouchProbe",
     [](Block &block, Bench &bench) {
         fb::FbTouchProbe &made = executed<fb::FbTouchProbe>(block, bench);
         block.takes("trigger_input", made.trigger_input, triggers);
         for (auto &[key, place] : {std::pair{"first_position", &made.first_position},
                                    std::pair{"last_position", &made.last_position}}) {
             block.inputs[key] = [&made, place = place](const std::string &word) {
                 made.window_only = true;
                 *place = number(word);
             };
         }
         block.gives_done(made.outputs);
         block.gives("CommandAborted", made.outputs.command_aborted);
         block.gives("RecordedPosition", made.recorded_position);
     }},
    {"MC_AbortTrigger",
     [](Block &block, Bench &bench) {
         fb::FbAbortTrigger &made = executed<fb::FbAbortTrigger>(block, bench);
         made.trigger_input = home;
         block.gives_done(made.outputs);
     }},
    {"MC_ReadDigitalInput",
     [](Block &block, Bench &bench) {
         fb::FbReadDigitalInput &made = reads<fb::FbReadDigitalInput>(block, bench);
         block.takes("input_number", made.input_number);
         block.gives("Value", made.value);
     }},
    {"MC_ReadDigitalOutput",
     [](Block &block, Bench &bench) {
         fb::FbReadDigitalOutput &made = reads<fb::FbReadDigitalOutput>(block, bench);
         block.takes("output_number", made.output_number);
         block.gives("Value", made.value);
     }},
    {"MC_WriteDigitalOutput",
     [](Block &block, Bench &bench) {
         fb::FbWriteDigitalOutput &made = writes<fb::FbWriteDigitalOutput>(block, bench);
         block.takes("output_number", made.output_number);
         block.takes("bool_value", made.value);
     }},
    {"MC_ReadParameter",
     [](Block &block, Bench &bench) {
         fb::FbReadParameter &made = reads<fb::FbReadParameter>(block, bench);
         block.takes("parameter", made.parameter_number, parameters);
         block.gives("Value", made.value);
     }},
    {"MC_ReadBoolParameter",
     [](Block &block, Bench &bench) {
         fb::FbReadBoolParameter &made = reads<fb::FbReadBoolParameter>(block, bench);
         block.takes("bool_parameter", made.parameter_number, parameters);
         block.gives("Value", made.value);
     }},
    {"MC_WriteParameter",
     [](Block &block, Bench &bench) {
         fb::FbWriteParameter &made = writes<fb::FbWriteParameter>(block, bench);
         block.takes("parameter", made.parameter_number, parameters);
         block.takes("value", made.value);
     }},
    {"MC_WriteBoolParameter",
     [](Block &block, Bench &bench) {
         fb::FbWriteBoolParameter &made = writes<fb::FbWriteBoolParameter>(block, bench);
         block.takes("bool_parameter", made.parameter_number, parameters);
         block.takes("bool_value", made.value);
     }},
    {"MC_ReadActualPosition",
     [](Block &block, Bench &bench) {
         block.gives("Position", reads<fb::FbReadActualPosition>(block, bench).value);
     }},
    {"MC_ReadActualVelocity",
     [](Block &block, Bench &bench) {
         block.gives("Velocity", reads<fb::FbReadActualVelocity>(block, bench).value);
     }},
    {"MC_ReadActualTorque",
     [](Block &block, Bench &bench) {
         block.gives("Torque", reads<fb::FbReadActualTorque>(block, bench).value);
     }},
    {"MC_ReadStatus",
     [](Block &block, Bench &bench) {
         fb::FbReadStatus &made = reads<fb::FbReadStatus>(block, bench);
         block.gives("ErrorStop", made.error_stop);
         block.gives("Disabled", made.disabled);
         block.gives("Stopping", made.stopping);
         block.gives("Homing", made.homing);
         block.gives("Standstill", made.standstill);
         block.gives("DiscreteMotion", made.discrete_motion);
         block.gives("ContinuousMotion", made.continuous_motion);
         block.gives("SynchronizedMotion", made.synchronized_motion);
     }},
    {"MC_ReadAxisError",
     [](Block &block, Bench &bench) {
         block.gives("AxisErrorID", reads<fb::FbReadAxisError>(block, bench).axis_error_id);
     }},
    {"MC_ReadMotionState",
     [](Block &block, Bench &bench) {
         fb::FbReadMotionState &made = reads<fb::FbReadMotionState>(block, bench);
         block.gives("ConstantVelocity", made.constant_velocity);
         block.gives("Accelerating", made.accelerating);
         block.gives("Decelerating", made.decelerating);
         block.gives("DirectionPositive", made.direction_positive);
         block.gives("DirectionNegative", made.direction_negative);
     }},
    {"MC_ReadAxisInfo",
     [](Block &block, Bench &bench) {
         fb::FbReadAxisInfo &made = reads<fb::FbReadAxisInfo>(block, bench);
         block.gives("HomeAbsSwitch", made.home_abs_switch);
         block.gives("LimitSwitchPos", made.limit_switch_pos);
         block.gives("LimitSwitchNeg", made.limit_switch_neg);
         block.gives("Simulation", made.simulation);
         block.gives("CommunicationReady", made.communication_ready);
         block.gives("ReadyForPowerOn", made.ready_for_power_on);
         block.gives("PowerOn", made.power_on);
         block.gives("IsHomed", made.is_homed);
         block.gives("AxisWarning", made.axis_warning);
     }},
};

/// What changes before the calls of a cycle.
struct Event {
    long cycle;
    std::string name, key, value;
};

struct Program {
    long cycles = 0;
    bool is_powered = false;
    Bench bench;
    std::vector<std::unique_ptr<Block>> blocks;
    std::vector<Event> events;

    void apply(const Event &event) {
        if (event.name == "axis") {
            bench.set(event.key, event.value);
            return;
        }
        for (auto &block : blocks) {
            if (block->name == event.name) {
                const auto input = block->inputs.find(event.key);
                if (input == block->inputs.end()) {
                    fail(event.name + " has no input " + event.key);
                }
                input->second(event.value);
                return;
            }
        }
        fail("there is no instance " + event.name);
    }

    void run() {
        if (is_powered) {
            bench.axis.set_power(true);
        }
        for (auto &block : blocks) {
            std::printf("outputs %s", block->name.c_str());
            for (auto &[name, value] : block->outputs) {
                std::printf(" %s", name);
            }
            std::printf("\n");
            block->told.assign(block->outputs.size(), 0.0);
        }
        auto event = events.begin();
        for (long cycle = 0; cycle < cycles; ++cycle) {
            // The drive first: its inputs are sampled in the cycle of the axis.
            for (auto at = event; at != events.end() && at->cycle <= cycle; ++at) {
                if (at->name == "axis") {
                    apply(*at);
                }
            }
            bench.axis.cycle();
            bench.give_effort();
            for (; event != events.end() && event->cycle <= cycle; ++event) {
                if (event->name != "axis") {
                    apply(*event);
                }
            }
            for (auto &block : blocks) {
                block->call();
                for (std::size_t k = 0; k < block->outputs.size(); ++k) {
                    const double value = block->outputs[k].second();
                    if (value != block->told[k]) {
                        block->told[k] = value;
                        std::printf("%ld %s %s %.17g\n", cycle, block->name.c_str(), block->outputs[k].first, value);
                    }
                }
            }
        }
        std::printf("end\n");
    }
};

} // namespace

int main() {
    std::unique_ptr<Program> program;
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream words(line);
        std::string first, name, key, value;
        words >> first;
        if (first == "program") {
            program = std::make_unique<Program>();
            words >> program->cycles >> value;
            program->is_powered = value == "on";
        } else if (!program) {
            fail("no program has begun: " + line);
        } else if (first == "limits") {
            axis::MotionLimits limits{};
            words >> limits.max_velocity >> limits.max_acceleration >> limits.max_jerk;
            limits.max_deceleration = limits.max_acceleration;
            if (program->bench.axis.configure_limits(limits) != rt::ErrorCode::ok) {
                fail("the limits are refused: " + line);
            }
        } else if (first == "block") {
            words >> name >> key;
            auto block = std::make_unique<Block>();
            block->name = name;
            choice(makes, key)(*block, program->bench);
            program->blocks.push_back(std::move(block));
        } else if (first == "end") {
            program->run();
            program.reset();
        } else {
            words >> name >> key >> value;
            program->events.push_back({std::strtol(first.c_str(), nullptr, 10), name, key, value});
        }
    }
}
