# Forwards to pipelines/Makefile: `make chute` here is `make -C pipelines chute`; `make` alone lists the targets.
# Commands and file names that are given to make are seen from the folder pipelines; only PREFIX is seen from here.
ifneq ($(PREFIX),)
prefix := PREFIX='$(abspath $(PREFIX))'
endif
.PHONY: FORCE
help: FORCE
	@$(MAKE) --no-print-directory -C pipelines help
pipelines/%: FORCE
	@$(MAKE) --no-print-directory -C pipelines $* $(prefix)
%: FORCE
	@$(MAKE) --no-print-directory -C pipelines $@ $(prefix)
FORCE: ;
Makefile: ;
