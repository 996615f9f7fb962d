// The parts of the page, in the order of their weight: driving and the stop depend on none of the pictures.
import "/drive.js";
import "/tabs.js";
import "/header.js";
import "/why.js";
import "/control.js";
import "/speed.js";
import "/gait.js";
import "/calls.js";
import "/setup.js";
import "/logs.js";
import "/replay.js";
import "/help.js";
import { connect } from "/link.js";

const PATIENCE = 1000;  // ms; a page that is hidden is not painted

connect();
await new Promise((resolve) => {  // the pictures begin behind the first one of the page
  new PerformanceObserver(resolve).observe({ type: "paint", buffered: true });
  setTimeout(resolve, PATIENCE);
});
await Promise.allSettled([import("/scene.js"), import("/map.js"), import("/plots.js")]);
