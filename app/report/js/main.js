jp.start(({plan: jp.draw_plan, diagnosis: jp.draw_diagnosis, compare: jp.draw_compare, front: jp.draw_front, batch: jp.draw_batch})[document.documentElement.dataset.kind]);
