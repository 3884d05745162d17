#include <isostat/core/error.hpp>
#include <isostat/crafted/inspection.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace isostat::crafted {

namespace {

constexpr std::size_t longest_list = 60;

/// "12-40, 3-left": the first ones and how many more.
template <class Range, class Text> std::string joined(const Range& range, Text text) {
    std::string out;
    std::size_t count = 0;
    for (const auto& element : range) {
        if (++count <= longest_list) {
            out += (out.empty() ? "" : ", ") + text(element);
        }
    }
    return count > longest_list ? fmt::format("{}, and {} more", out, count - longest_list) : out;
}

std::vector<int> disks_with(const Inspection& inspection, DiskHold hold) {
    std::vector<int> out;
    for (std::size_t i = 0; i < inspection.hold.size(); ++i) {
        if (inspection.hold[i] == hold) {
            out.push_back(static_cast<int>(i));
        }
    }
    return out;
}

std::string vector_text(const std::vector<Number>& vector, const std::vector<std::string>& names) {
    std::vector<std::size_t> entries;
    for (std::size_t k = 0; k < vector.size(); ++k) {
        if (!vector[k].is_zero()) {
            entries.push_back(k);
        }
    }
    return joined(entries, [&](std::size_t k) { return fmt::format("{}: {}", names[k], vector[k].text()); });
}

std::string number_list(const std::vector<int>& numbers) {
    return numbers.empty() ? "none" : joined(numbers, [](int i) { return std::to_string(i); });
}

} // namespace

const char* to_string(DiskHold hold) {
    switch (hold) {
    case DiskHold::held: return "held";
    case DiskHold::bridge: return "bridge";
    case DiskHold::rattler: return "rattler";
    case DiskHold::fixed: return "fixed";
    case DiskHold::loaded: return "loaded";
    }
    return "";
}

const char* to_string(Support support) {
    switch (support) {
    case Support::positive: return "positive";
    case Support::with_zeros: return "with zeros";
    case Support::none: return "none";
    case Support::unbalanced: return "unbalanced";
    case Support::undecided: return "undecided";
    case Support::no_load: return "no load";
    }
    return "";
}

const char* to_string(SecondOrder answer) {
    switch (answer) {
    case SecondOrder::no_mechanism: return "no mechanism";
    case SecondOrder::rigid: return "rigid";
    case SecondOrder::flexes: return "flexes";
    case SecondOrder::undecided: return "undecided";
    }
    return "";
}

const char* to_string(exact::OneSign sign) {
    switch (sign) {
    case exact::OneSign::strict: return "strict";
    case exact::OneSign::partial: return "partial";
    case exact::OneSign::none: return "none";
    }
    return "";
}

std::string to_text(const Inspection& inspection, const ExactPacking& packing) {
    const DofMap<2> dofs(approximate(packing));
    std::vector<std::string> contact_names, dof_names;
    for (const Contact& contact : inspection.contacts) {
        contact_names.push_back(to_string<2>(contact));
    }
    for (int d = 0; d < dofs.dof_count(); ++d) {
        dof_names.push_back(dofs.name(d));
    }
    const bool exact = inspection.rank_exact == Verdict::proved;
    const char* most = exact ? "" : "<= ";
    std::string out;
    const auto line = [&](const std::string& key, const std::string& value) {
        out += fmt::format("{:<22} {}\n", key, value);
    };
    line("disks", std::to_string(packing.disk_count()));
    line("degrees of freedom N_f", std::to_string(inspection.dof_count));
    line("contacts N", fmt::format("{} (gaps decided exactly)", inspection.contacts.size()));
    line("contact list",
         inspection.contacts.empty() ? "none" : joined(contact_names, [](const std::string& name) { return name; }));
    line("rank", fmt::format("{}{} ({})", exact ? "" : ">= ", inspection.rank,
                             exact ? "proved" : "lower bound proved, upper bound undecided"));
    line("hyperstaticity h", fmt::format("{}{}", most, inspection.hyperstaticity));
    line("mechanisms k", fmt::format("{}{} ({} common rigid motions, {}{} internal)", most, inspection.mechanisms,
                                     inspection.rigid_motions, most, inspection.internal_mechanisms()));
    line("verdict", inspection.verdict());
    line("generic rank", fmt::format("{} (same contact graph, random coordinates)", inspection.generic_rank));
    line("special position", std::string(to_string(inspection.special_position)));
    line("rattlers", number_list(disks_with(inspection, DiskHold::rattler)));
    line("bridges", number_list(disks_with(inspection, DiskHold::bridge)));
    if (inspection.forces_unique &&
        (inspection.support == Support::positive || inspection.support == Support::with_zeros)) {
        line("disks without force", number_list(inspection.without_force));
    }
    std::vector<std::string> idle;
    for (std::size_t l = 0; l < contact_names.size(); ++l) {
        if (inspection.carrying[l] == 0) {
            idle.push_back(contact_names[l]);
        }
    }
    line("contacts without force",
         idle.empty() ? "none by position of the normals" : joined(idle, [](const std::string& s) { return s; }));
    line("self-stress, one sign", inspection.one_sign_decided ? to_string(inspection.one_sign.kind) : "undecided");
    line("support of the load",
         fmt::format("{}{}", to_string(inspection.support), inspection.forces_unique ? " (forces unique)" : ""));
    if (!inspection.forces.empty()) {
        line(inspection.forces_unique ? "forces" : "forces, one choice", vector_text(inspection.forces, contact_names));
    }
    std::vector<std::string> structural, special;
    for (std::size_t l = 0; l < inspection.structural_zero.size(); ++l) {
        if (inspection.forces[l].is_zero()) {
            (inspection.structural_zero[l] != 0 ? structural : special).push_back(contact_names[l]);
        }
    }
    if (!structural.empty()) {
        line("zero for any position", joined(structural, [](const std::string& s) { return s; }));
    }
    if (!special.empty()) {
        line("zero by position", joined(special, [](const std::string& s) { return s; }));
    }
    line("second order (bars)", to_string(inspection.second_order));
    line("stable", packing.load ? std::string(to_string(inspection.stable)) : "no load");
    if (inspection.bases_exact == Verdict::proved) {
        for (std::size_t s = 0; s < std::min<std::size_t>(inspection.self_stresses.size(), 10); ++s) {
            line(fmt::format("self-stress {}", s + 1), vector_text(inspection.self_stresses[s], contact_names));
        }
        for (std::size_t m = 0; m < std::min<std::size_t>(inspection.motions.size(), 10); ++m) {
            line(fmt::format("motion {}", m + 1), vector_text(inspection.motions[m], dof_names));
        }
    }
    return out;
}

std::vector<std::string> check_expected(const Inspection& inspection, const PackingFile& file,
                                        const std::string& source) {
    std::vector<std::string> out;
    const bool exact = inspection.rank_exact == Verdict::proved;
    // A count that is only a bound matches nothing.
    const auto count = [&](int value) { return exact ? std::to_string(value) : "undecided"; };
    const std::map<std::string, std::string> words = {
        {"N_f", std::to_string(inspection.dof_count)},
        {"N", std::to_string(inspection.contacts.size())},
        {"rank", count(inspection.rank)},
        {"h", count(inspection.hyperstaticity)},
        {"k", count(inspection.mechanisms)},
        {"rigid_motions", std::to_string(inspection.rigid_motions)},
        {"generic_rank", std::to_string(inspection.generic_rank)},
        {"special", std::string(to_string(inspection.special_position))},
        {"verdict", inspection.verdict()},
        {"one_sign", inspection.one_sign_decided ? to_string(inspection.one_sign.kind) : "undecided"},
        {"support", to_string(inspection.support)},
        {"second_order", to_string(inspection.second_order)},
        {"stable", std::string(to_string(inspection.stable))},
    };
    const auto mismatch = [&](const ExpectedEntry& entry, const std::string& wanted, const std::string& found) {
        out.push_back(fmt::format("{}:{}: {}: expected {}, found {}", source, entry.line, entry.key, wanted, found));
    };
    const auto bad = [&](const ExpectedEntry& entry, const std::string& wanted) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}:{}: expected.{}: expected {}", source, entry.line, entry.key, wanted));
    };
    for (const ExpectedEntry& entry : file.expected) {
        if (const auto word = words.find(entry.key); word != words.end()) {
            if (entry.values.size() != 1 || entry.values[0].size() != 1) {
                bad(entry, "one value");
            }
            if (entry.values[0][0] != word->second) {
                mismatch(entry, entry.values[0][0], word->second);
            }
        } else if (entry.key == "contacts" || entry.key == "rattlers" || entry.key == "bridges" ||
                   entry.key == "without_force" || entry.key == "structural_zeros") {
            std::vector<std::string> wanted, found;
            for (const auto& row : entry.values) {
                wanted.insert(wanted.end(), row.begin(), row.end());
            }
            if (entry.key == "contacts") {
                for (const Contact& contact : inspection.contacts) {
                    found.push_back(to_string<2>(contact));
                }
            } else if (entry.key == "structural_zeros") {
                for (std::size_t l = 0; l < inspection.structural_zero.size(); ++l) {
                    if (inspection.structural_zero[l] != 0) {
                        found.push_back(to_string<2>(inspection.contacts[l]));
                    }
                }
            } else if (entry.key == "without_force") {
                for (const int i : inspection.without_force) {
                    found.push_back(std::to_string(i));
                }
                if (!inspection.forces_unique) {
                    found.emplace_back("forces that are not unique");
                }
            } else {
                for (const int i :
                     disks_with(inspection, entry.key == "rattlers" ? DiskHold::rattler : DiskHold::bridge)) {
                    found.push_back(std::to_string(i));
                }
            }
            std::sort(wanted.begin(), wanted.end());
            std::sort(found.begin(), found.end());
            if (wanted != found) {
                mismatch(entry, fmt::format("[{}]", fmt::join(wanted, ", ")),
                         fmt::format("[{}]", fmt::join(found, ", ")));
            }
        } else if (entry.key == "forces") {
            for (const auto& row : entry.values) {
                if (row.size() != 2) {
                    bad(entry, "pairs [contact, force]");
                }
                const Number wanted = [&] {
                    try {
                        return Number::parse(row[1]);
                    } catch (const Error& error) {
                        throw Error(ErrorKind::bad_input,
                                    fmt::format("{}:{}: expected.forces: {}", source, entry.line, error.what()));
                    }
                }();
                std::string found = inspection.forces_unique ? "no such contact" : "forces that are not unique";
                bool holds = false;
                for (std::size_t l = 0; l < inspection.contacts.size() && inspection.forces_unique; ++l) {
                    if (to_string<2>(inspection.contacts[l]) == row[0]) {
                        found = inspection.forces[l].text();
                        holds = inspection.forces[l] == wanted;
                    }
                }
                if (!holds) {
                    mismatch(entry, row[0] + " = " + wanted.text(), found);
                }
            }
        } else {
            bad(entry, "a known key: N_f, N, rank, h, k, rigid_motions, generic_rank, special, verdict, contacts, "
                       "forces, rattlers, bridges, without_force, structural_zeros, "
                       "one_sign, support, second_order or stable");
        }
    }
    return out;
}

} // namespace isostat::crafted
