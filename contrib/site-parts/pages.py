"""Pages of the site from Markdown, as GitHub shows it: links between files become links between pages."""

import html
import posixpath
import re

import markdown_it
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_by_name

import parameters

LANGUAGES = {"cpp": "cpp", "c++": "cpp", "python": "python", "py": "python", "cmake": "cmake"}


def slug(text):
    """As GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def plain(tokens):
    return "".join(token.content if token.type in ("text", "code_inline") else " " if token.type == "softbreak" else ""
                   for token in tokens)


class Page:
    """title, body (HTML), headings [(level, anchor, text)] and texts [(anchor, heading, words)] of one Markdown file."""

    def __init__(self, text, source, url, resolve, known):
        """`source`: path in the repository; `url`: of the page; resolve(path, fragment) is the URL of a file of the repository."""
        self.source, self.url = source, url
        self.headings, self.texts = [], []
        parser = markdown_it.MarkdownIt("commonmark", {"html": True}).enable("table")
        tokens = parser.parse(text)
        used, section = {}, ["", "", []]
        self.title = ""
        for i, token in enumerate(tokens):
            if token.type == "heading_open":
                words = plain(tokens[i + 1].children)
                name = slug(words)
                used[name] = used.get(name, -1) + 1
                name += "-%d" % used[name] if used[name] else ""
                token.attrSet("id", name)
                self.title = self.title or words
                self.headings.append((int(token.tag[1]), name, words))
                self.texts.append(section)
                section = [name, words, []]
            elif token.type == "inline":
                section[2].append(plain(token.children))
                for child in token.children:
                    for attribute in ("href", "src"):
                        target = child.attrGet(attribute)
                        if target is not None:
                            child.attrSet(attribute, self.link(target, resolve))
            elif token.type in ("fence", "code_block"):
                section[2].append(token.content)
        self.texts.append(section)
        self.texts = [(a, h, " ".join(" ".join(words).split())) for a, h, words in self.texts if words]

        rules = parser.renderer.rules
        to_parameters = relative(url, "parameters.html")

        def code(tokens, i, *_):
            content, language = tokens[i].content, tokens[i].info.strip()
            if not language and parameters.is_scene(content):
                return '<pre class="scene">%s</pre>\n' % parameters.highlight(content, known, to_parameters)
            if language in LANGUAGES:
                return highlight(content, get_lexer_by_name(LANGUAGES[language]), HtmlFormatter(cssclass="code"))
            return "<pre>%s</pre>\n" % html.escape(content)

        rules["fence"] = rules["code_block"] = code
        rules["table_open"] = lambda *_: '<div class="wide"><table>\n'
        rules["table_close"] = lambda *_: "</table></div>\n"
        self.body = re.sub(r"<!--.*?-->", "", parser.renderer.render(tokens, parser.options, {}), flags=re.S)

    def link(self, target, resolve):
        if re.match(r"[a-z]+:", target):
            return target
        path, _, fragment = target.partition("#")
        if path:
            path = posixpath.normpath(posixpath.join(posixpath.dirname(self.source), path))
        else:
            path = self.source
        return relative(self.url, resolve(path)) + ("#" + fragment if fragment else "")


def relative(page, url):
    """URL of one page of the site, as a link on another."""
    return posixpath.relpath(url, posixpath.dirname(page) or ".")

