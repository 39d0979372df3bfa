jp.start(({plan: jp.draw_plan, diagnosis: jp.draw_diagnosis, compare: jp.draw_compare, front: jp.draw_front, batch: jp.draw_batch, sweep: jp.draw_sweep})[document.documentElement.dataset.kind]);
