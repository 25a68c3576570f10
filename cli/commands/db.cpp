#include "timbre/cli/commands/db.h"

#include <memory>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/options.h"
#include "timbre/index/store.h"

namespace timbre::cli {
namespace {

void add_db_create(CLI::App& db, Context& context) {
  struct Arguments {
    std::string database;
    OperatorOptions op;
    int count = StoreParameters().count;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *db.add_subcommand("create", "A new, empty database");
  command.add_option("DB", args->database, "file to make")->required();
  add_operator_options(command, args->op);
  command.add_option("-k,--count", args->count, "eigenvalues kept of each shape")
      ->capture_default_str()
      ->check(CLI::Range(2, 100000));
  add_common_options(command, context, false);
  command.footer("Example:\n  timbre db create shapes.timbre --mass consistent");
  command.callback([args, &context] {
    const Store store =
        Store::create(args->database, {args->op.kind, mass_of(args->op), args->count});
    context.answer(
        {{"database", args->database}, {"parameters", to_parameters(store.parameters())}},
        "created " + escape_control(args->database) + "\n");
  });
}

void add_db_list(CLI::App& db, Context& context) {
  auto database = std::make_shared<std::string>();
  CLI::App& command = *db.add_subcommand("list", "Names, labels and sizes of the shapes");
  command.add_option("DB", *database, "the database")->required();
  add_common_options(command, context, false);
  command.footer(
      "Text columns, parted by tabs: name, label, vertices, faces.\n"
      "Example:\n  timbre db list shapes.timbre | cut -f 1");
  command.callback([database, &context] {
    nlohmann::json shapes = nlohmann::json::array();
    std::string text;
    for (const ShapeInfo& shape : Store::open(*database).list()) {
      shapes.push_back(
          {{"name", shape.name},
           {"label", shape.label.empty() ? nlohmann::json() : nlohmann::json(shape.label)},
           {"vertices", shape.vertices},
           {"faces", shape.faces},
           {"area", shape.area},
           {"content", to_hex(shape.content)}});
      text += shape.name + '\t' + shape.label + '\t' + std::to_string(shape.vertices) + '\t' +
              std::to_string(shape.faces) + '\n';
    }
    context.answer({{"shapes", shapes}}, text);
  });
}

void add_db_remove(CLI::App& db, Context& context) {
  struct Arguments {
    std::string database;
    std::vector<std::string> names;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *db.add_subcommand("remove", "Takes shapes out");
  command.add_option("DB", args->database, "the database")->required();
  command.add_option("NAMES", args->names, "shapes to take out")->required();
  add_common_options(command, context, false);
  command.footer("Example:\n  timbre db remove shapes.timbre cat3 cat4");
  command.callback([args, &context] {
    Store store = Store::open(args->database, StoreAccess::write);
    for (const std::string& name : args->names) {
      store.remove(name);
      context.say("removed " + name);
    }
    if (context.json) context.answer({{"removed", args->names}}, "");
  });
}

void add_db_verify(CLI::App& db, Context& context) {
  auto database = std::make_shared<std::string>();
  CLI::App& command = *db.add_subcommand("verify", "Reads everything and checks it");
  command.add_option("DB", *database, "the database")->required();
  add_common_options(command, context, false);
  command.footer(
      "Ends with 1 if anything is damaged. Checksums find accidents, not forgery.\n"
      "Example:\n  timbre db verify shapes.timbre");
  command.callback([database, &context] {
    const VerifyReport report = Store::open(*database).verify(context.progress());
    nlohmann::json names = nlohmann::json::array();
    nlohmann::json findings = nlohmann::json::array();
    std::string text;
    for (const Damage& damage : report.damaged) {
      const std::string name = damage.name.empty() ? *database : damage.name;
      if (names.empty() || names.back() != name) names.push_back(name);
      findings.push_back({{"name", name}, {"cause", damage.cause}});
      text += escape_control(name + ": " + damage.cause) + '\n';
    }
    text += std::to_string(report.checked) + " shapes checked, " +
            (report.damaged.empty() ? "no damage" : std::to_string(names.size()) + " damaged") +
            '\n';
    if (!report.damaged.empty()) context.exit_code = 1;
    context.answer({{"checked", report.checked}, {"damaged", names}, {"findings", findings}}, text);
  });
}

}  // namespace

void add_db(CLI::App& timbre, Context& context) {
  CLI::App& db = *timbre.add_subcommand("db", "The database of shapes");
  db.require_subcommand(1);
  add_db_create(db, context);
  add_db_add(db, context);
  add_db_list(db, context);
  add_db_remove(db, context);
  add_db_verify(db, context);
  add_db_export(db, context);
}

}  // namespace timbre::cli
