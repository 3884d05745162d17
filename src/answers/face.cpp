#include "answers/state.hpp"
#include "io/text.hpp"
#include "preparation/force_face.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace isostat::answers {

using json::Json;
using json::or_null;
using text::say;

namespace {

/// The names of the contacts that a run recorded.
std::vector<std::string> names_of(const std::vector<std::pair<Contact, Enclosure>>& noted, int dimension) {
    std::vector<std::string> names;
    for (const auto& [contact, term] : noted) {
        names.push_back(to_string(contact, dimension));
    }
    return names;
}

bool takes_part(const ForceFace& face, std::size_t l) {
    return std::ranges::any_of(face.self_stresses, [l](const std::vector<double>& stress) { return stress[l] != 0; });
}

Result<ForceFace> face_of(const State& state) {
    std::vector<Contact> touching;
    for (const auto& [pair, gap] : state.perturbation->open) {
        touching.push_back(pair);
    }
    return force_face(state.packing, state.load, state.contacts, touching);
}

void print_ends(std::string& out, const ForceFace& face, int dimension) {
    for (std::size_t l = 0; l < face.pairs.size(); ++l) {
        if (takes_part(face, l)) {
            say(out, "  force {:<16} from {:.6g} to {:.6g}\n", to_string(face.pairs[l], dimension), face.least[l],
                face.most[l]);
        }
    }
    say(out, "  (the run found that these touch; the ends are computed in double, not proved)\n");
}

Json face_json(const Result<ForceFace>& result, int dimension) {
    if (!result.ok()) {
        return {{"undecided", result.failure().message(dimension)}};
    }
    const ForceFace& face = result.value();
    Json stresses = Json::array();
    for (const std::vector<double>& stress : face.self_stresses) {
        Json one;
        for (std::size_t l = 0; l < stress.size(); ++l) {
            if (stress[l] != 0) {
                one[to_string(face.pairs[l], dimension)] = or_null(stress[l]);
            }
        }
        stresses.push_back(std::move(one));
    }
    Json between = Json::array();
    for (std::size_t l = 0; l < face.pairs.size(); ++l) {
        if (takes_part(face, l)) {
            between.push_back({to_string(face.pairs[l], dimension), or_null(face.least[l]), or_null(face.most[l])});
        }
    }
    return {{"h", face.self_stresses.size()},
            {"self_stresses", std::move(stresses)},
            {"forces_between", std::move(between)},
            {"proved", false}};
}

} // namespace

void print_face(std::string& out, const State& state) {
    if (!state.perturbation) {
        return;
    }
    if (!state.perturbation->open.empty()) {
        say(out, "touching besides         {}: {} self-stresses, the forces above are one choice of many\n",
            fmt::format("{}", fmt::join(names_of(state.perturbation->open, state.packing.dimension), ", ")),
            state.perturbation->open.size());
        const Result<ForceFace> face = face_of(state);
        if (face.ok()) {
            print_ends(out, face.value(), state.packing.dimension);
        } else {
            say(out, "  {}: {}\n", to_string(face.failure().kind), face.failure().message(state.packing.dimension));
        }
    }
    if (!state.perturbation->zero.empty()) {
        say(out, "left at force 0          {}: an equilibrium of the finite loads, whatever infinitesimal ones do\n",
            fmt::format("{}", fmt::join(names_of(state.perturbation->zero, state.packing.dimension), ", ")));
    }
}

void add_face(Json& object, const State& state) {
    if (!state.perturbation) {
        return;
    }
    if (!state.perturbation->open.empty()) {
        object["face"] = face_json(face_of(state), state.packing.dimension);
        object["face"]["touching"] = names_of(state.perturbation->open, state.packing.dimension);
    }
    if (!state.perturbation->zero.empty()) {
        object["left_at_zero"] = names_of(state.perturbation->zero, state.packing.dimension);
    }
}

} // namespace isostat::answers
