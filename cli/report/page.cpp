#include "timbre/cli/report/page.h"

#include "timbre/cli/report/embedded_text.h"
#include "timbre/cli/report/html.h"

namespace timbre::cli {

std::string page(std::string_view title, std::string_view content, bool has_viewer) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'";
  if (has_viewer) html += "; script-src 'unsafe-inline'";
  html += "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += "<meta name=\"color-scheme\" content=\"light dark\">\n";
  html += element("title", escape_html(title)) + "\n";
  html += element("style", page_css()) + "\n</head>\n<body>\n";
  html += content;
  // Text that could end a script would end it: of these two it is known that it does not.
  if (has_viewer) html += element("script", three_js()) + "\n" + element("script", viewer_js());
  return html + "\n</body>\n</html>\n";
}

}  // namespace timbre::cli
