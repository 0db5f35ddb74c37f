// Runs a Structured Text source in the compiler and virtual machine of pyplcopen, for the requests on standard input.
//
// The source has a program `Bench` with the variables below. A request and its answer are those of the example `generator_lines` of
// the crate `plcopen`; with the argument `memory` it prints the bytes that each instance takes instead. Inputs are written to, and outputs read from, the memory of the instance, whose layout the compiler tells.
#include "st/st.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace st = plcopen::core::st;

namespace {

constexpr std::uint64_t most = 10'000'000;

[[noreturn]] void fail(const std::string &why) {
    std::cerr << why << '\n';
    std::exit(1);
}

/// A variable of the program.
class Cell {
public:
    Cell(const st::Program &program, unsigned char *memory, const char *name) {
        for (const st::VarInfo &variable : program.vars) {
            if (variable.lower == name) {
                place_ = memory + variable.offset;
            }
        }
        if (place_ == nullptr) {
            fail(std::string("the program has no variable ") + name);
        }
    }

    void set(double value) { std::memcpy(place_, &value, sizeof value); }
    void set_bool(bool value) { *place_ = value ? 1 : 0; }
    /// INT and SINT, little-endian as this machine.
    void set_int(std::int16_t value) { std::memcpy(place_, &value, sizeof value); }
    void set_sint(std::int8_t value) { std::memcpy(place_, &value, sizeof value); }

    std::uint64_t bits() const {
        std::uint64_t bits = 0;
        std::memcpy(&bits, place_, sizeof bits);
        return bits;
    }
    double number() const {
        double value = 0.0;
        std::memcpy(&value, place_, sizeof value);
        return value;
    }
    bool is_true() const { return *place_ != 0; }

private:
    unsigned char *place_ = nullptr;
};

} // namespace

int main(int count, char **words) {
    if (count < 2) {
        fail("the first argument is the source");
    }
    const std::string mode = count > 2 ? words[2] : "";
    const bool is_traced = mode == "trace";
    std::ifstream file(words[1]);
    std::stringstream source;
    source << file.rdbuf();

    const st::CompileResult compiled = st::compile(source.str());
    for (const st::Diagnostic &diagnostic : compiled.diagnostics) {
        std::cerr << diagnostic.line << ':' << diagnostic.column << ": " << diagnostic.message << '\n';
    }
    if (!compiled.ok) {
        fail("the source is not compiled");
    }
    if (mode == "memory") {
        for (const st::InstanceInfo &instance : compiled.program.instances) {
            std::printf("%s %u\n", instance.name.c_str(), static_cast<unsigned>(instance.bytes));
        }
        return 0;
    }
    const st::Program &program = compiled.program.programs.empty() ? compiled.program : compiled.program.programs.front();
    std::vector<std::uint64_t> memory(program.required_bytes() / 8 + 1);
    auto *bytes = reinterpret_cast<unsigned char *>(memory.data());
    st::Instance instance;
    if (instance.load(program, bytes, memory.size() * 8, 1'000'000) != plcopen::core::rt::ErrorCode::ok) {
        fail("the program is not loaded");
    }

    const auto cell = [&](const char *name) { return Cell(program, bytes, name); };
    Cell method = cell("inmethod"), order = cell("inorder"), enable = cell("inenable"), reversed = cell("inreversed");
    Cell reference = cell("inreference"), actual = cell("inactual");
    Cell settings[] = {cell("insample"), cell("insettling"), cell("invelocity"), cell("inacceleration"), cell("injerk"), cell("insnap")};
    const Cell numbers[] = {cell("outx"), cell("outv"), cell("outa"), cell("outj"), cell("outs"), cell("outadded")};
    const Cell done = cell("outdone"), ready = cell("outready"), error = cell("outerror");

    std::string line;
    while (std::getline(std::cin, line)) {
        std::istringstream stream(line);
        std::vector<double> request;
        for (std::string word; stream >> word;) {
            request.push_back(std::strtod(word.c_str(), nullptr));
        }
        if (request.size() < 9) {
            fail("a request has ten words at least: " + line);
        }
        std::uint64_t samples = 0;
        std::uint64_t sum = 0xcbf29ce484222325ULL;
        const auto call = [&] {
            if (instance.scan(1'000'000) != st::ScanError::ok) {
                fail("the machine stops at " + line);
            }
            const std::uint64_t flags = (done.is_true() ? 1 : 0) | (ready.is_true() ? 2 : 0) | (error.is_true() ? 4 : 0);
            for (const Cell &number : numbers) {
                sum = (sum ^ number.bits()) * 0x00000100000001b3ULL;
            }
            sum = (sum ^ flags) * 0x00000100000001b3ULL;
            samples += 1;
            if (is_traced) {
                for (const Cell &number : numbers) {
                    std::printf("%.17g ", number.number());
                }
                std::printf("%llu\n", static_cast<unsigned long long>(flags));
            }
        };
        order.set_int(static_cast<std::int16_t>(request[0]));
        for (int k = 0; k < 6; ++k) {
            settings[k].set(request[1 + k]);
        }
        reversed.set_bool(request[7] != 0.0);
        actual.set(request[8]);
        reference.set(0.0);
        enable.set_bool(false);
        method.set_sint(0);
        call();
        method.set_sint(1);
        for (std::size_t k = 9; k < request.size(); ++k) {
            reference.set(request[k]);
            actual.set(numbers[0].number());
            enable.set_bool(true);
            call();
            enable.set_bool(false);
            std::uint64_t calls = 0;
            do {
                call();
                if (++calls > most) {
                    fail("the move does not end: " + line);
                }
            } while (!done.is_true() && !error.is_true());
        }
        if (!is_traced) {
            std::printf("%llu %016llx\n", static_cast<unsigned long long>(samples), static_cast<unsigned long long>(sum));
        }
    }
    return 0;
}
