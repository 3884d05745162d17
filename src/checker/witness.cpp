#include "checker/way.hpp"
#include "io/json.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <limits>

namespace isostat::checker {

namespace {

using json::Field;

std::vector<double> numbers(const Field& list) {
    std::vector<double> values;
    for (std::size_t k = 0; k < list.size(); ++k) {
        values.push_back(list.at(k).number());
    }
    return values;
}

} // namespace

Witnesses::Witnesses(std::filesystem::path file) : file_(std::move(file)) {
    std::ifstream in(file_, std::ios::binary);
    const std::string begin = "{\"step\":";
    int line = 1;
    long at = 0;
    for (std::string text; std::getline(in, text); ++line) {
        long step = 0;
        const auto [stop, error] =
            std::from_chars(text.data() + std::min(begin.size(), text.size()), text.data() + text.size(), step);
        if (!text.starts_with(begin) || error != std::errc() || !begin_.insert({step, {at, line}}).second) {
            throw Error(
                ErrorKind::bad_input,
                fmt::format("{}:{}: expected one object for each arc, with its step first", file_.string(), line));
        }
        at += static_cast<long>(text.size()) + 1;
    }
}

std::optional<Witness> Witnesses::of(long step) const {
    const auto found = begin_.find(step);
    if (found == begin_.end()) {
        return {};
    }
    std::ifstream in(file_, std::ios::binary);
    in.seekg(found->second.first);
    std::string text;
    std::getline(in, text);
    const std::string where = fmt::format("{}:{}", file_.string(), found->second.second);
    const json::Json parsed = Field::parse(text, where);
    const Field line(parsed, where);
    line.only({"step", "grains", "centres", "end"});
    if (line.at("step").integer() != step) {
        line.at("step").fail(fmt::format("{}, as the line begins", step));
    }
    if (!line.has("end")) {
        return {};
    }
    constexpr int most = std::numeric_limits<int>::max();
    Witness witness;
    if (line.has("grains")) {
        const Field list = line.at("grains");
        witness.grains.emplace();
        for (std::size_t k = 0; k < list.size(); ++k) {
            witness.grains->push_back(list.at(k).integer(0, most));
        }
    }
    const Field centres = line.at("centres");
    for (std::size_t k = 0; k < centres.size(); ++k) {
        const Field centre = centres.at(k);
        centre.only({"held", "q"});
        witness.centres.push_back({centre.at("held").integer(-1, most), numbers(centre.at("q"))});
    }
    witness.end = numbers(line.at("end"));
    return witness;
}

} // namespace isostat::checker
