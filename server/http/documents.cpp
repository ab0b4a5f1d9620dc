#include "server/http/documents.h"

#include "proto/base64.h"
#include "proto/documents.h"
#include "server/http/pages.h"
#include "server/store/artifact_store.h"
#include "solver/core/result.h"

#include <cstddef>
#include <string_view>
#include <utility>

namespace modelsynth::server {

namespace {

// JSON as the content of a script element: nothing in it ends the element.
std::string within_script(std::string_view json) {
    std::string text;
    for (const char c : json) {
        if (c == '<') {
            text += "\\u003c";
        } else {
            text += c;
        }
    }
    return text;
}

// The page with a document where it says {{name}}.
std::string with_document(std::string page, const std::string& name, std::string_view json) {
    const std::string mark = "{{" + name + "}}";
    const std::size_t place = page.find(mark);
    check(place != std::string::npos, "a page has no place for a document");
    return page.replace(place, mark.size(), within_script(json));
}

// 'sha256-...' of a text, as a policy names what may run.
std::string policy_source(std::string_view text) {
    const std::string hex = sha256_hex(text);
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    }
    return " 'sha256-" + proto::encode_base64(bytes) + "'";
}

// The sources of all elements of a name that have no attributes.
std::string policy_sources(std::string_view page, const std::string& element) {
    const std::string begin = "<" + element + ">";
    const std::string end = "</" + element + ">";
    std::string sources;
    for (std::size_t at = page.find(begin); at != std::string_view::npos;
         at = page.find(begin, at)) {
        at += begin.size();
        sources += policy_source(page.substr(at, page.find(end, at) - at));
    }
    return sources;
}

Documents::Document make_document(std::string text) {
    std::string etag = "\"";
    etag.append(sha256_hex(text)).append("\"");
    return {std::move(text), std::move(etag)};
}

// Its own scripts and styles may run, and reach this server; all else is forbidden.
Documents::Document make_page(std::string html) {
    Documents::Document made = make_document(std::move(html));
    made.policy = "default-src 'none'; script-src" + policy_sources(made.text, "script") +
                  "; style-src" + policy_sources(made.text, "style") +
                  "; connect-src 'self'; img-src 'self' data:; base-uri 'none'; form-action 'none'"
                  "; frame-ancestors 'none'";
    return made;
}

}  // namespace

Documents make_documents(std::string limits) {
    Documents documents;
    documents.limits = std::move(limits);
    documents.openapi = make_document(proto::openapi_json());
    documents.asyncapi = make_document(proto::asyncapi_json());
    documents.docs = make_page(with_document(
        with_document(kDocsPage, "openapi", documents.openapi.text),
        "asyncapi",
        documents.asyncapi.text
    ));
    documents.start = make_page(kStartPage);
    return documents;
}

}  // namespace modelsynth::server
