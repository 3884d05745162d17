#include "answers/state.hpp"
#include "preparation/force_face.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace isostat::answers {

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

/// The self-stresses, and the ranges of the forces that they change.
void add_ends(Answer& out, const ForceFace& face, int dimension) {
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
            const std::string name = to_string(face.pairs[l], dimension);
            between.push_back({name, or_null(face.least[l]), or_null(face.most[l])});
            say(out.text, "  force {:<16} from {:.6g} to {:.6g}\n", name, face.least[l], face.most[l]);
        }
    }
    say(out.text, "  (the run found that these touch; the ends are computed in double, not proved)\n");
    out.json.update({{"h", face.self_stresses.size()},
                     {"self_stresses", std::move(stresses)},
                     {"forces_between", std::move(between)},
                     {"proved", false}});
}

} // namespace

void add_face(Answer& out, const State& state) {
    if (!state.perturbation) {
        return;
    }
    const int dimension = state.packing.dimension;
    if (const std::vector<std::string> names = names_of(state.perturbation->open, dimension); !names.empty()) {
        Answer part;
        part.item("touching", names, "touching besides",
                  "{}: {} self-stresses, the forces above are one choice of many",
                  fmt::format("{}", fmt::join(names, ", ")), names.size());
        if (const Result<ForceFace> face = face_of(state); face.ok()) {
            add_ends(part, face.value(), dimension);
        } else {
            const std::string reason = face.failure().message(dimension);
            part.item("undecided", reason);
            say(part.text, "  {}: {}\n", to_string(face.failure().kind), reason);
        }
        out.part("face", std::move(part));
    }
    if (const std::vector<std::string> names = names_of(state.perturbation->zero, dimension); !names.empty()) {
        out.item("left_at_zero", names, "left at force 0",
                 "{}: an equilibrium of the finite loads, whatever infinitesimal ones do",
                 fmt::format("{}", fmt::join(names, ", ")));
    }
}

} // namespace isostat::answers
