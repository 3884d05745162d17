#include "cli/import_contacts.hpp"

#include "cli/import_source.hpp"
#include "contact/words.hpp"
#include "crafted/peeling.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/io/foreign.hpp>

#include <algorithm>
#include <iterator>
#include <optional>

namespace isostat::cli {

namespace {

/// The contacts of the widest range of thresholds with an isostatic backbone, or at the threshold given.
Result<Wanted> wanted_below(const ImportArguments& a, const Packing<2>& packing) {
    const double largest = a.threshold.value_or(nearly_touching * packing.min_radius());
    if (a.threshold) {
        const crafted::PlateauStep step = crafted::plateau(packing, {largest}).steps.front();
        if (step.backbone.isostatic != Verdict::proved) {
            return isostat::failed(step.backbone.isostatic == Verdict::refuted ? FailureKind::not_isostatic
                                                                               : FailureKind::undecided,
                                   "at the threshold {} the backbone has N_f = {}, N = {}, h = {}, k = {}: expected "
                                   "an isostatic one",
                                   largest, step.backbone.dof_count, step.backbone.contact_count,
                                   step.backbone.hyperstaticity, step.backbone.mechanisms);
        }
        return Wanted{false, crafted::backbone_at(packing, largest), fmt::format("gaps up to {}", largest)};
    }
    const double deepest = std::min(crafted::plateau(packing, {largest}).deepest_overlap, largest);
    const crafted::Plateau plateau = crafted::plateau(packing, deepest, largest, 1);
    if (plateau.ranges.empty()) {
        return isostat::failed(plateau.special.empty() ? FailureKind::not_isostatic : FailureKind::undecided,
                               "the backbone is isostatic at no threshold up to {:.6g}: isostat plateau shows the "
                               "counts, --contacts nearest takes the vertex downhill whatever its contacts",
                               largest);
    }
    const auto range =
        *std::max_element(plateau.ranges.begin(), plateau.ranges.end(),
                          [](const auto& x, const auto& y) { return x.last - x.first < y.last - y.first; });
    return Wanted{
        false, crafted::backbone_at(packing, range.first),
        fmt::format("isostatic backbone at every threshold from {:.6g} to {:.6g}, proved", range.first, range.last)};
}

/// Those that can carry a force by the positions of the normals: soft rattlers touch now and then.
std::vector<Contact> backbone_of(const Packing<2>& packing, const std::vector<Contact>& contacts) {
    const std::vector<int> from = crafted::peel(packing, contacts).contact_from;
    std::vector<Contact> out;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (from[l] <= static_cast<int>(contacts.size())) {
            out.push_back(contacts[l]);
        }
    }
    return out;
}

/// Pairs with a force, and the walls that a disk overlaps.
Wanted wanted_by_forces(const ImportArguments& a, const ReadPacking& file) {
    const std::vector<std::string> columns = parse_list(a.contact_columns);
    if (columns.size() != 3) {
        throw Error(ErrorKind::usage,
                    fmt::format("--contact-columns is '{}': expected I,J,FORCE, names of columns of {}",
                                a.contact_columns, a.contacts));
    }
    if (file.ids.empty()) {
        refuse(a.file, "has no column id: expected one, the contacts speak of ids");
    }
    std::optional<long> frame;
    if (a.foreign.frame != "last") {
        frame = std::stol(a.foreign.frame); // read once already
    }
    Wanted wanted;
    wanted.contacts = read_local_dump(a.contacts, {columns[0], columns[1], columns[2]}, file.ids, frame);
    const std::size_t pairs = wanted.contacts.size();
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int i = 0; i < file.packing.disk_count(); ++i) {
            for (int axis = 0; axis < 2; ++axis) {
                if (gap<2>(file.packing, {kind, i, axis}) <= 0) {
                    wanted.contacts.push_back({kind, i, axis});
                }
            }
        }
    }
    wanted.words = fmt::format("{} pairs with a force in {}, {} overlaps with walls, without rattlers", pairs,
                               a.contacts, wanted.contacts.size() - pairs);
    std::sort(wanted.contacts.begin(), wanted.contacts.end());
    wanted.contacts = backbone_of(file.packing, wanted.contacts);
    return wanted;
}

std::string names_of(const std::vector<Contact>& contacts) {
    constexpr std::size_t most = 8;
    std::string text;
    for (std::size_t k = 0; k < std::min(most, contacts.size()); ++k) {
        text += " " + to_string<2>(contacts[k]);
    }
    return contacts.empty()         ? " none"
           : contacts.size() > most ? fmt::format("{} and {} more", text, contacts.size() - most)
                                    : text;
}

} // namespace

Result<Wanted> wanted_contacts(const ImportArguments& a, const ReadPacking& file) {
    if (a.threshold || a.contacts == "plateau") {
        return wanted_below(a, file.packing);
    }
    return a.contacts == "nearest" ? Wanted{true, {}, ""} : wanted_by_forces(a, file);
}

std::vector<Contact> carrying(const State<2>& state, const Certification& truth) {
    std::vector<Contact> out;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        if (truth.structural_zero.size() != state.contacts.size() || truth.structural_zero[l] == 0) {
            out.push_back(state.contacts[l]);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

Result<std::string> compared(const Wanted& wanted, const std::vector<Contact>& found) {
    if (wanted.any) {
        return fmt::format("{} carry a force, as the nearest vertex has them", found.size());
    }
    std::vector<Contact> lost, added;
    std::set_difference(wanted.contacts.begin(), wanted.contacts.end(), found.begin(), found.end(),
                        std::back_inserter(lost));
    std::set_difference(found.begin(), found.end(), wanted.contacts.begin(), wanted.contacts.end(),
                        std::back_inserter(added));
    if (lost.empty() && added.empty()) {
        return fmt::format("{} carry a force, those of the file: {}", found.size(), wanted.words);
    }
    return isostat::failed(FailureKind::not_isostatic,
                           "the vertex downhill has other contacts than the file ({}): without{}; with{}; expected "
                           "the same, or --contacts nearest",
                           wanted.words, names_of(lost), names_of(added));
}

} // namespace isostat::cli
