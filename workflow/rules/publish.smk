# Pictures, the page, and what the whole run says of itself.


rule publish:
    input:
        of_drawn_designs("results/designs/{design}/figures"),
        "results/figures/together",
        "results/figures/simulated",
        of_generative_half("results/figures/generative"),
        of_screening("results/figures/screening"),
        "results/report/index.html",
        "results/ro-crate-metadata.json",


rule figures:
    input:
        geometry=rules.prepare.output.geometry,
        repair=rules.prepare.output.repair,
        mesh=rules.prepare.output.mesh,
        solve=rules.solve.output.solve,
        metrics=rules.metrics.output.metrics,
    output:
        figures=report(
            directory("results/designs/{design}/figures"),
            patterns=["{picture}.png"],
            caption="../report/design.rst",
            category="Designs",
            subcategory="{design}",
            labels={"picture": "{picture}"},
        ),
    log:
        "results/logs/figures/{design}.log",
    benchmark:
        "results/benchmarks/figures/{design}.tsv"
    resources:
        mem_mb=2000,
        runtime=20,
    params:
        version=STAGE_VERSIONS["figures"],
        config=config_of_pictures(),
        design=design_folder,
    message:
        "Draw design {wildcards.design}: geometry, mesh, shapes, contact and blocked force."
    shell:
        "pagd figures {params.design:q} --config {params.config:q}"
        " --keep-going --out {output.figures:q} > {log:q} 2>&1"


rule export:
    input:
        geometry=rules.prepare.output.geometry,
        repair=rules.prepare.output.repair,
        mesh=rules.prepare.output.mesh,
        solve=rules.solve.output.solve,
        metrics=rules.metrics.output.metrics,
        figures=pictures_of_design,
    output:
        export=directory("results/report/designs/{design}"),
    log:
        "results/logs/export/{design}.log",
    benchmark:
        "results/benchmarks/export/{design}.tsv"
    retries: RETRIES
    resources:
        mem_mb=growing(2000),
        runtime=growing(20),
        tries_left=tries_left,
        tmpdir=None,
    params:
        version=STAGE_VERSIONS["export"],
        config=config_of("export"),
        design=design_folder,
    message:
        "Export design {wildcards.design}: surfaces, solids, moulds, tables, card of the page."
    shell:
        "pagd export {params.design:q} --config {params.config:q}"
        " --allotted {resources.runtime} {resources.mem_mb} {resources.tries_left}"
        " --keep-going --out {output.export:q} > {log:q} 2>&1"


rule pictures_together:
    input:
        mesh=of_drawn_designs(rules.prepare.output.mesh),
        solve=of_drawn_designs(rules.solve.output.solve),
        metrics=of_drawn_designs(rules.metrics.output.metrics),
    output:
        pictures=report(
            directory("results/figures/together"),
            patterns=["{picture}.png"],
            caption="../report/together.rst",
            category="All designs",
            labels={"picture": "{picture}"},
        ),
    log:
        "results/logs/pictures_together.log",
    benchmark:
        "results/benchmarks/pictures_together.tsv"
    resources:
        mem_mb=2000,
        runtime=20,
    params:
        version=STAGE_VERSIONS["figures"],
        resolution_dpi=CONFIG["figures"]["resolution_dpi"],
        designs=folders_of,
    message:
        "Draw the designs together: shapes, trajectories, angles and blocked forces."
    script:
        "../scripts/pictures_together.py"


rule pictures_simulated:
    input:
        performance=rules.summary_tables.output.performance,
    output:
        pictures=report(
            directory("results/figures/simulated"),
            patterns=["{picture}.png"],
            caption="../report/generative.rst",
            category="All designs",
            labels={"picture": "{picture}"},
        ),
    log:
        "results/logs/pictures_simulated.log",
    benchmark:
        "results/benchmarks/pictures_simulated.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["generative_figures"],
        resolution_dpi=CONFIG["figures"]["resolution_dpi"],
    message:
        "Draw what became of the simulated designs."
    script:
        "../scripts/pictures_generative.py"


rule pictures_generative:
    input:
        dataset=rules.dataset.output.dataset,
        embedding=rules.embedding.output.embedding,
        generated=rules.generate.output.generated,
        diversity=rules.diversity.output.diversity,
    output:
        pictures=report(
            directory("results/figures/generative"),
            patterns=["{picture}.png"],
            caption="../report/generative.rst",
            category="Generated designs",
            labels={"picture": "{picture}"},
        ),
    log:
        "results/logs/pictures_generative.log",
    benchmark:
        "results/benchmarks/pictures_generative.tsv"
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["generative_figures"],
        resolution_dpi=CONFIG["figures"]["resolution_dpi"],
    message:
        "Draw embedding, mixture, hulls, and the comparison of generators."
    script:
        "../scripts/pictures_generative.py"


rule pictures_screened:
    input:
        generated=rules.generate.output.generated,
        screened="results/screening/generated",
        screened_training="results/screening/training",
        full=rules.summary_tables.output.performance,
    output:
        pictures=report(
            directory("results/figures/screening"),
            patterns=["{picture}.png"],
            caption="../report/generative.rst",
            category="Screened designs",
            labels={"picture": "{picture}"},
        ),
    log:
        "results/logs/pictures_screened.log",
    benchmark:
        "results/benchmarks/pictures_screened.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["generative_figures"],
        resolution_dpi=CONFIG["figures"]["resolution_dpi"],
        pictures=SCREENED_PICTURES,
    message:
        "Draw what generated and training designs can do, and how new it is."
    script:
        "../scripts/pictures_generative.py"


rule report_page:
    input:
        mesh=of_exported_designs(rules.prepare.output.mesh),
        solve=of_exported_designs(rules.solve.output.solve),
        metrics=of_exported_designs(rules.metrics.output.metrics),
        cards=of_exported_designs(rules.export.output.export),
        pictures=rules.pictures_together.output.pictures,
        study=list(STUDY.values()),
    output:
        page="results/report/index.html",
    log:
        "results/logs/report_page.log",
    benchmark:
        "results/benchmarks/report_page.tsv"
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["report"],
        designs=folders_of,
        study=STUDY,
    message:
        "Write the page: results/report/index.html."
    script:
        "../scripts/report_page.py"


rule run_crate:
    input:
        performance=rules.summary_tables.output.performance,
        page=rules.report_page.output.page,
    output:
        metadata="results/ro-crate-metadata.json",
        provenance=directory("results/provenance"),
    log:
        "results/logs/run_crate.log",
    benchmark:
        "results/benchmarks/run_crate.tsv"
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        version=STAGE_VERSIONS["run_crate"],
        configuration=json.dumps(CONFIG),
        tables=files_of_configuration(),
    message:
        "Describe what has made the results in results/ro-crate-metadata.json."
    script:
        "../scripts/run_crate.py"
