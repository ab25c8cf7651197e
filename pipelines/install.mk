# make install PREFIX=…: the tools, their man pages, completions for bash, zsh and fish, and the rules of plants.
.PHONY: install uninstall
ALL_TOOLS := $(notdir $(patsubst %/,%,$(dir $(wildcard ../tools/*/*/Cargo.toml))))
PREFIX ?= /usr/local
SHARE = $(DESTDIR)$(PREFIX)/share
install: build ## install the tools, their man pages and completions, and plant.mk below PREFIX (/usr/local)
	@cd .. && $(CARGO) build --release --locked -p grainpipe-pages
	mkdir -p $(DESTDIR)$(PREFIX)/bin $(SHARE)/grainpipe
	install -m 755 $(ALL_TOOLS:%=$(BIN)/%) $(DESTDIR)$(PREFIX)/bin
	install -m 644 plant.mk $(SHARE)/grainpipe
	$(BIN)/grainpipe-pages $(SHARE) $(ALL_TOOLS:%=$(BIN)/%)

uninstall: ## remove what install has written below PREFIX
	rm -f $(ALL_TOOLS:%=$(DESTDIR)$(PREFIX)/bin/%) $(SHARE)/grainpipe/plant.mk $(ALL_TOOLS:%=$(SHARE)/man/man1/%.1)
	rm -f $(ALL_TOOLS:%=$(SHARE)/bash-completion/completions/%) $(ALL_TOOLS:%=$(SHARE)/zsh/site-functions/_%) $(ALL_TOOLS:%=$(SHARE)/fish/vendor_completions.d/%.fish)
