#include "answers/genericity.hpp"

#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "io/files.hpp"

namespace isostat::cli {

int genericity(const GenericityArguments& a) {
    check_output(a.csv, answers::genericity_head, {a.file});
    answers::GenericityAnswer answer{a.file, answers::read_original(a.file), a.options,
                                     static_cast<std::size_t>(a.lists)};
    const bool text = !a.common.json;
    if (text) {
        say_lines(answers::head_text(answer));
    }
    Json results = Json::array();
    std::string csv = answers::genericity_head;
    std::vector<crafted::Genericity> all;
    bool every = true;
    for (const double size : a.sizes) {
        answer.options.size = size;
        all.push_back(crafted::genericity(answer.original.packing, answer.original.contacts, answer.options));
        const crafted::Genericity& result = all.back();
        every = every && result.proved == a.options.samples;
        csv += answers::csv_rows(result, size);
        if (text) {
            say_lines(answers::row_text(result, size));
        } else {
            results.push_back(answers::to_json(answer, result, size));
        }
    }
    if (!a.csv.empty()) {
        write_output(a.csv, csv, answers::genericity_head);
    }
    if (text) {
        say_lines(answers::closing_text(answer, all, a.sizes));
    } else {
        Json object = document("isostat-genericity 1", a.common);
        answers::add_genericity(object, answer, std::move(results));
        print_json(object);
    }
    return every ? done : undecided;
}

} // namespace isostat::cli
