#include "report/page.hpp"

#include "core/dot.hpp"
#include "core/refuse.hpp"
#include "io/equilibria.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "io/text.hpp"
#include "linear/factorisation.hpp"
#include "packing/bodies.hpp"
#include "packing/words.hpp"
#include "report/charts.hpp"
#include "report/run_walk.hpp"
#include "rigidity/isostatic.hpp"

#include <fmt/format.h>
#include <nettle/base64.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

namespace isostat {

namespace {

using checker::EventRecord;
using checker::RunRecords;
using json::Json;

constexpr int parts_of_radius = 256;          ///< positions are rounded to this part of the mean radius
constexpr int parts_of_longest = 31;          ///< arrows, of the longest one
constexpr int parts_of_force = 16;            ///< forces, of the mean one
constexpr std::size_t most_coordinates = 6e6; ///< of all frames: some MB of file

/// Columns of equilibria.csv that the page shows.
constexpr std::array columns{"number",    "previous",   "segment",     "sigma2",         "ratio",
                             "eps1",      "eps2",       "arcs",        "rattlers",       "backbone",
                             "contacts",  "h",          "held",        "margin",         "proved",
                             "certified", "sigma2_low", "sigma2_high", "solid_fraction", "decided_by"};

/// The number of a disk, and above it the periods of its image in two signed bytes.
std::int64_t disk_with_image(const Contact& contact, int disks) {
    constexpr std::int64_t byte = 256;
    const auto part = [&](std::size_t a) {
        return static_cast<std::int64_t>(static_cast<std::uint8_t>(contact.image.m[a]));
    };
    return contact.j + disks * (part(0) + byte * part(1));
}

/// A contact as in equilibria.csv: two numbers, where walls are -1 to -4 and a held coordinate is (its index, -9).
void append_contact(Json& list, const Contact& contact, const Packing& packing) {
    list.push_back(contact.i);
    list.push_back(contact.of_disks() ? disk_with_image(contact, packing.disk_count())
                                      : contact_columns(contact).second);
}

/// The forces of an equilibrium in double, or an empty list.
std::vector<double> forces_of(const State& state) {
    const auto structure = IsostaticStructure::prove(state.packing, state.contacts);
    if (!structure.ok()) {
        return {};
    }
    std::vector<double> forces = on_dofs(state.load.external_force(state.packing), structure.value().dofs());
    Factorisation(structure.value()).solve_forces(forces);
    return forces;
}

std::vector<double> difference(const State& to, const State& from) {
    std::vector<double> moved(to.packing.q.size());
    std::ranges::transform(to.packing.q, from.packing.q, moved.begin(), std::minus<>());
    return moved;
}

/// Which vertices become frames.
struct Thinning {
    std::size_t arcs = 1;       ///< one arc in so many
    std::size_t equilibria = 1; ///< one equilibrium in so many, by number
    Thinning(const RunRecords& records, std::size_t coordinates) {
        const std::size_t most = std::max<std::size_t>(1, most_coordinates / coordinates);
        const std::size_t rows = records.equilibria.size();
        equilibria = rows / most + 1;
        arcs = records.events.size() / std::max<std::size_t>(1, most - std::min(most, rows)) + 1;
    }
    [[nodiscard]] bool keeps(const WalkedVertex& vertex, const RunRecords& records) const {
        if (vertex.equilibrium != nullptr) {
            return vertex.relisted || static_cast<std::size_t>(vertex.state.equilibrium) % equilibria == 0;
        }
        return static_cast<std::size_t>(vertex.arc - records.events.data()) % arcs == 0;
    }
    [[nodiscard]] std::string words() const {
        const auto some = [](std::size_t every, const char* what) {
            return every == 1 ? "" : fmt::format(" {} of {} {}", every - 1, every, what);
        };
        const std::string left = some(arcs, "ends of arcs") + some(equilibria, "equilibria");
        return left.empty() ? "" : "the packing at" + left + ": the page would be too large";
    }
};

/// Writes the frames in order.
class Frames {
  public:
    explicit Frames(const Packing& packing) {
        const std::vector<double>& radius = packing.radius;
        resolution_ =
            std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size()) / parts_of_radius;
        last_.resize(packing.q.size(), 0);
    }

    void add(const WalkedVertex& vertex, const RunRecords& records) {
        const State& state = vertex.state;
        for (std::size_t k = 0; k < last_.size(); ++k) {
            const std::int64_t now = std::llround(state.packing.q[k] / resolution_);
            append_varint(moves_, now - last_[k]);
            last_[k] = now;
        }
        event_.push_back(vertex.arc != nullptr ? vertex.arc - records.events.data() : -1);
        equilibrium_.push_back(vertex.equilibrium != nullptr ? state.equilibrium : -1);
        list_.push_back(vertex.relisted ? static_cast<int>(lists_.size()) : -1);
        if (vertex.relisted) {
            Json& list = lists_.emplace_back(Json::array());
            for (const Contact& contact : state.contacts) {
                append_contact(list, contact, state.packing);
            }
        }
        arrow_.push_back(add_arrows(vertex.from, state));
        const bool one_arc = vertex.arc != nullptr && vertex.arc->arc == 1;
        whole_.push_back(vertex.equilibrium == nullptr ? -1
                         : one_arc                     ? arrow_.back()
                                                       : add_arrows(vertex.start, state));
        force_.push_back(vertex.equilibrium != nullptr ? add_forces(state) : -1);
    }

    [[nodiscard]] Json json() const {
        Json object;
        object["resolution"] = resolution_;
        object["coordinates"] = last_.size();
        object["event"] = event_;
        object["equilibrium"] = equilibrium_;
        object["list"] = list_;
        object["arrow"] = arrow_;
        object["whole"] = whole_;
        object["force"] = force_;
        object["longest"] = longest_;
        object["force_count"] = force_count_;
        object["lists"] = lists_;
        object["parts"] = parts_of_force;
        object["moves"] = packed(moves_);
        object["arrows"] = packed(arrows_);
        object["forces"] = packed(forces_);
        return object;
    }

  private:
    /// Returns the number of the arrows; -1: no disk moved, or the motion is not known.
    int add_arrows(const State* from, const State& to) {
        if (from == nullptr) {
            return -1;
        }
        const std::vector<double> moved = difference(to, *from);
        const double longest = largest(moved);
        if (longest == 0) {
            return -1;
        }
        for (const double m : moved) {
            append_varint(arrows_, std::llround(m / longest * parts_of_longest));
        }
        longest_.push_back(longest);
        return static_cast<int>(longest_.size()) - 1;
    }

    int add_forces(const State& state) {
        const std::vector<double> forces = forces_of(state);
        double sum = 0;
        int carrying = 0;
        for (std::size_t l = 0; l < forces.size(); ++l) {
            const bool drawn = state.contacts[l].is_unilateral() && forces[l] != 0;
            sum += drawn ? std::abs(forces[l]) : 0;
            carrying += drawn ? 1 : 0;
        }
        if (carrying == 0) {
            return -1;
        }
        for (std::size_t l = 0; l < forces.size(); ++l) {
            const double part = std::abs(forces[l]) * carrying / sum * parts_of_force;
            const bool drawn = state.contacts[l].is_unilateral() && forces[l] != 0;
            forces_ += drawn ? static_cast<char>(std::clamp(std::llround(part), 1LL, 255LL)) : '\0';
        }
        force_count_.push_back(static_cast<int>(forces.size()));
        return static_cast<int>(force_count_.size()) - 1;
    }

    double resolution_;
    std::vector<std::int64_t> last_;
    std::string moves_, arrows_, forces_;
    std::vector<long> event_;
    std::vector<int> equilibrium_, list_, arrow_, whole_, force_, force_count_;
    std::vector<double> longest_;
    Json lists_ = Json::array();
};

Json equilibria_json(const RunRecords& records) {
    Json object;
    for (const char* name : columns) {
        object[name] = json::array_of(records.equilibria, [name](const EquilibriumLine& line) {
            return json::or_null(line.value.contains(name) ? line.at(name) : NAN);
        });
    }
    return object;
}

Json events_json(const RunRecords& records, const Packing& packing) {
    Json object;
    for (const char* name : {"equilibrium", "arc", "kind", "opened", "closed", "sigma2", "eps2", "displacement"}) {
        object[name] = Json::array();
    }
    for (const EventRecord& event : records.events) {
        object["equilibrium"].push_back(event.equilibrium);
        object["arc"].push_back(event.arc);
        object["kind"].push_back(event.kind);
        const Contact nothing{ContactKind::held, -1, 0};
        append_contact(object["opened"], checker::contact_named(event.opened, packing).value_or(nothing), packing);
        append_contact(object["closed"], checker::contact_named(event.closed, packing).value_or(nothing), packing);
        object["sigma2"].push_back(event.stress);
        object["eps2"].push_back(event.strain);
        object["displacement"].push_back(event.displacement);
    }
    return object;
}

Json packing_json(const State& state) {
    const Packing& packing = state.packing;
    Json object;
    object["radii"] = std::vector<float>(packing.radius.begin(), packing.radius.end());
    const Bodies bodies(packing);
    for (int i = 0; i < packing.disk_count() && !packing.bars.empty(); ++i) {
        object["body"].push_back(bodies.of(i));
    }
    object["fixed"] = packing.fixed;
    object["periodic"] = std::array{packing.cell.periodic[0], packing.cell.periodic[1]}; // a page shows the plane
    object["loaded_axis"] = state.load.loaded_axis;
    for (std::size_t a = 0; a < 2; ++a) {
        object["lower"].push_back(word_of(packing.walls.lower[a], wall_kind_words));
        object["upper"].push_back(word_of(packing.walls.upper[a], wall_kind_words));
    }
    return object;
}

Json header_json(const std::filesystem::path& directory) {
    const std::string path = (directory / "run.json").string();
    const Json parsed = json::Field::parse(read_text(path), path);
    const json::Field run(parsed, path);
    Json object;
    for (const char* name : {"scene_file", "program", "status"}) {
        object[name] = run.at(name).string();
    }
    object["segments"] = run.at("programme").value();
    const json::Field settings = run.at("settings").at("run");
    object["level"] = settings.at("certify").string();
    return object;
}

Json words_json(const LoadWords& words) {
    return {{"ratio", words.ratio_sign},
            {"strain", words.strain_sign},
            {"other_strain", words.other_strain},
            {"stress", words.stress_sign}};
}

} // namespace

void append_varint(std::string& bytes, std::int64_t value) {
    constexpr unsigned seven_bits = 0x7f;
    const auto doubled = static_cast<std::uint64_t>(value) << 1U;
    std::uint64_t rest = value < 0 ? ~doubled : doubled;
    for (; rest > seven_bits; rest >>= 7U) {
        bytes += static_cast<char>((rest & seven_bits) | (seven_bits + 1));
    }
    bytes += static_cast<char>(rest);
}

std::string packed(const std::string& bytes) {
    uLongf size = ::compressBound(bytes.size());
    std::string small(size, '\0');
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): both libraries have their own byte types
    const int status = ::compress2(reinterpret_cast<Bytef*>(small.data()), &size,
                                   reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
    if (status != Z_OK) {
        refuse(ErrorKind::internal, "zlib: {}", ::zError(status));
    }
    std::string text(BASE64_ENCODE_RAW_LENGTH(size), '\0');
    ::base64_encode_raw(text.data(), size, reinterpret_cast<const std::uint8_t*>(small.data()));
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    return text;
}

Page run_page(const std::filesystem::path& directory, const std::function<void(std::size_t, std::size_t)>& progress) {
    const RunRecords records = checker::read_records(directory, LastLine::may_be_cut);
    Page page;
    Json data = header_json(directory);
    std::optional<Frames> frames;
    const std::optional<StateFile> first = records.stored(0);
    data["words"] = words_json(load_words(first ? first->state.load : Load()));
    data["arcs"] = records.events.size();
    if (first) {
        const Packing& packing = first->state.packing;
        data["packing"] = packing_json(first->state);
        data["events"] = events_json(records, packing);
        frames.emplace(packing);
        const Thinning thinning(records, packing.q.size());
        page.left_out = walk_run(records, [&](const WalkedVertex& vertex) {
            if (thinning.keeps(vertex, records)) {
                frames->add(vertex, records);
            }
            if (progress && vertex.arc != nullptr) {
                progress(static_cast<std::size_t>(vertex.arc - records.events.data()) + 1, records.events.size());
            }
            return true;
        });
        if (!thinning.words().empty()) {
            page.left_out.push_back(thinning.words());
        }
        data["frames"] = frames->json();
    } else {
        page.left_out.emplace_back("the packing and its arcs: states/eq_000000.json is not there");
    }
    data["equilibria"] = equilibria_json(records);
    data["left_out"] = page.left_out;
    page.html = page_template;
    const std::string place = "@DATA@";
    page.html.replace(page.html.find(place), place.size(), text::in_script(json::dumped(data)));
    return page;
}

} // namespace isostat
